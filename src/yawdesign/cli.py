"""The command line: parses, calls, prints and sets the exit code."""

import json
import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from signal import SIGINT
from typing import TYPE_CHECKING, Annotated, Any

import typer

from yawdesign.output.streams import ANSWER, discard, open_streams, tell, write_answer

if TYPE_CHECKING:
    from yawdesign.problem import Problem

DONE, NOTHING_FEASIBLE, BAD_INPUT, SOLVER_FAILED, STOPPED = 0, 1, 2, 3, 128  # 128 and the number of the signal

app = typer.Typer(
    help="Yaw damper design for motor bogies: hunting stability, curving limit and optimum.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

ProblemFile = Annotated[str, typer.Argument(metavar="PROBLEM.YAML", help="The problem file.", show_default=False)]
AsJson = Annotated[bool, typer.Option("--json", help="Print the result as JSON, in SI units.")]
Force = Annotated[bool, typer.Option("--force", help="Replace files that are there.")]


@contextmanager
def _mistakes_shown() -> Iterator[None]:
    from yawdesign.problem import ProblemError
    from yawdesign.problem.diagnostics import UnitWarning

    try:
        with _warnings_told(UnitWarning):
            yield
    except ProblemError as error:
        tell(str(error))
        raise typer.Exit(BAD_INPUT) from None
    except OSError as error:
        tell(f"error: {_reason(error)}")
        raise typer.Exit(BAD_INPUT) from None
    except KeyboardInterrupt as error:
        tell("interrupted")
        raise typer.Exit(_stopped(error)) from None


def _stopped(error: BaseException | None) -> int:
    """Return the exit code of somebody's request to stop: 130 after Ctrl-C."""
    return STOPPED + getattr(error, "number", SIGINT)


def _reason(error: Exception) -> str:
    if not isinstance(error, OSError):
        return f"{type(error).__name__}: {error}"
    if error.filename == ANSWER:
        return f"{ANSWER} could not be written: {error.strerror}"
    return (error.strerror or str(error)) + (f": {error.filename}" if error.filename else "")


def _read(path: str) -> "Problem":
    """Return the problem of a file; warnings go to standard error."""
    from yawdesign.problem import ProblemError, read

    problem, diagnostics = read(path)
    if problem is None:
        raise ProblemError(diagnostics)
    for diagnostic in diagnostics:
        tell(diagnostic.render())
    return problem


def _show(result: Any, as_json: bool, tables: str, home: str = "yawdesign.output.tables") -> None:
    from yawdesign.output.tables import rendered

    if as_json:
        write_answer(json.dumps(result.to_dict(), indent=2, allow_nan=False) + "\n")
    else:
        write_answer(rendered(getattr(import_module(home), tables)(result)))


def _code(checked: bool, feasible: bool) -> int:
    if not checked:
        return SOLVER_FAILED
    return DONE if feasible else NOTHING_FEASIBLE


def _answer(file: str, as_json: bool, home: str, function: str) -> None:
    with _mistakes_shown():
        problem = _read(file)
        result = getattr(import_module(home), function)(problem)
        _show(result, as_json, f"{function}_tables")
    raise typer.Exit(_code(result.checked, result.stable))


@app.command()
def stability(file: ProblemFile, as_json: AsJson = False) -> None:
    """Tell whether the bogie is stable with its C_s, with all modes and margins."""
    _answer(file, as_json, "yawdesign.hunting.verdict", "stability")


@app.command()
def design(file: ProblemFile, as_json: AsJson = False) -> None:
    """Find the stable yaw damping, the curve's limit and the golden section between them."""
    _answer(file, as_json, "yawdesign.damper.forward", "design")


@app.command()
def optimise(
    file: ProblemFile,
    as_json: AsJson = False,
    seed: Annotated[
        int, typer.Option(min=0, help="Of the search points; with more than three variables try a few.")
    ] = 0,
) -> None:
    """Find the C_s, K_m and C_m (or other variables) of largest stability margin that the curve allows."""
    with _mistakes_shown():
        problem = _read(file)
        with _progress() as progress:
            from yawdesign.damper.optimise import optimise as best

            result = best(problem, seed=seed, progress=progress)
        _show(result, as_json, "optimum_tables")
    raise typer.Exit(_code(result.status != "unverified", result.status == "optimal"))


app.command("optimize", hidden=True)(optimise)


@app.command()
def sweep(
    file: ProblemFile,
    over: Annotated[
        list[str], typer.Option(metavar="NAME=LOW:HIGH:N[:log]", help="An axis; one to three.", show_default=False)
    ],
    of: Annotated[
        str,
        typer.Option(help="stable, decay_rate, damping_ratio, margin, critical, C_sl, design or critical_speed."),
    ] = "C_sl",
    hold: Annotated[str | None, typer.Option(help="C_m (default) or xi_m: what stays when f_m changes.")] = None,
    csv: Annotated[str | None, typer.Option(help="Write a table.")] = None,
    npz: Annotated[str | None, typer.Option(help="Write arrays for NumPy.")] = None,
    plot: Annotated[str | None, typer.Option(help="Draw a picture: .png, .pdf or .svg.")] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1,
    dask: Annotated[str | None, typer.Option(help="Address of a dask scheduler that computes.")] = None,
    resume: Annotated[str | None, typer.Option(help="File that keeps unfinished work, and goes on from it.")] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Answer one question at every point of a grid of parameters: curves, maps, stability charts."""
    with _mistakes_shown():
        problem = _read(file)
        from yawdesign.output.sweep_files import Outputs
        from yawdesign.problem.stopping import held
        from yawdesign.study.executors import workers
        from yawdesign.study.request import request

        asked = request(problem, of, [(name, values) for name, _, values in (x.partition("=") for x in over)], hold)
        outputs = Outputs.checked(file, asked.axes, csv=csv, npz=npz, plot=plot, resume=resume, force=force)
        with workers(jobs, dask) as executor, held():
            result = _swept(asked, outputs, {"executor": executor, "resume": resume})
            _write_sweep(result, outputs, as_json)
    raise typer.Exit(_code(not result.unverified.any(), bool(result.good.any())))


def _swept(asked: Any, outputs: Any, options: dict[str, Any]) -> Any:
    """Return a sweep that came to its end; of another one what is finished is kept."""
    from yawdesign.study.sweep import IncompleteSweepError, answered

    try:
        with _progress() as progress, _warnings_told():
            return answered(asked, progress=progress, **options)
    except IncompleteSweepError as error:
        tell(outputs.rescued(error.result, error.reason))
        raise typer.Exit(_stopped(error.__cause__) if error.interrupted else SOLVER_FAILED) from None


def _write_sweep(result: Any, outputs: Any, as_json: bool) -> None:
    """Write and show a sweep, and keep it if that fails or somebody stops it."""
    from yawdesign.problem import ProblemError
    from yawdesign.problem.stopping import let_through

    try:
        outputs.write(result)
        with let_through():
            _show_sweep(result, as_json)
    except KeyboardInterrupt as error:
        tell(outputs.rescued(result, f"it was stopped ({error})"))
        raise typer.Exit(_stopped(error)) from None
    except Exception as error:  # noqa: BLE001 - whatever it is, it may not cost the sweep
        tell(outputs.rescued(result, _unwritten(error)))
        code = BAD_INPUT if isinstance(error, (OSError, ProblemError)) else SOLVER_FAILED
        raise typer.Exit(code) from None


def _show_sweep(result: Any, as_json: bool) -> None:
    from yawdesign.output import sweep_tables as study_tables
    from yawdesign.output import tables

    if as_json:
        write_answer(json.dumps(result.to_dict(), allow_nan=False) + "\n")
    else:
        write_answer(tables.rendered(study_tables.sweep_tables(result)))


def _unwritten(error: Exception) -> str:
    from yawdesign.problem import ProblemError

    if isinstance(error, OSError):
        return f"{error.filename or ANSWER} could not be written: {error.strerror}"
    if isinstance(error, ProblemError):
        return f"the results could not be written: {str(error).removeprefix('error: ')}"
    return f"the results could not be shown: {type(error).__name__}: {error}"


@contextmanager
def _warnings_told(kind: type[Warning] = RuntimeWarning) -> Iterator[None]:
    """Show warnings as messages."""
    with warnings.catch_warnings():
        warnings.showwarning = lambda message, *_: tell(f"warning: {message}")
        warnings.simplefilter("always", kind)
        yield


@app.command()
def simulate(
    file: ProblemFile,
    as_json: AsJson = False,
    track: Annotated[
        str,
        typer.Option(
            help="german-low, german-high, fra-1 ... fra-6, german:A_a=..,A_v=.., fra:A=.., harmonic, sinusoid, "
            "smooth, or a file with a measured track or a spectrum."
        ),
    ] = "german-low",
    speed: Annotated[
        list[str] | None, typer.Option(help="Such as '300 km/h', in place of the problem's; may be repeated.")
    ] = None,
    duration: Annotated[str | None, typer.Option(help="Of each run; 60 s, or the whole measured track.")] = None,
    length: Annotated[str | None, typer.Option(help="Of each run, instead of a duration, such as '2000 m'.")] = None,
    step: Annotated[str | None, typer.Option(help="Largest time step; 1 ms, or finer where needed.")] = None,
    start: Annotated[str, typer.Option(help="stationary, rest or offset.")] = "stationary",
    offset: Annotated[str | None, typer.Option(help="Lateral displacement for --start offset; 10 mm.")] = None,
    band: Annotated[
        tuple[str, str] | None, typer.Option(help="Of a spectrum; '0.3 Hz' '40 Hz', or in 1/m along the track.")
    ] = None,
    wavelength: Annotated[str | None, typer.Option(help="Of --track harmonic; 20 m.")] = None,
    amplitude: Annotated[str | None, typer.Option(help="Of --track harmonic, 5 mm, or sinusoid, 1 m.")] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Of a spectrum's random phases; 0.")] = None,
    csv: Annotated[str | None, typer.Option(help="Write the time histories as text.")] = None,
    npz: Annotated[str | None, typer.Option(help="Write the time histories as NumPy arrays.")] = None,
    plot: Annotated[str | None, typer.Option(help="Draw the frame's motion to a .png, .pdf or .svg file.")] = None,
    response: Annotated[str | None, typer.Option(help="What --plot draws; y_b.")] = None,
    force: Force = False,
) -> None:
    """Run the bogie over a track: RMS, peaks, whether amplitudes settle, and what its yaw damper has to do."""
    with _mistakes_shown():
        from yawdesign.output import histories, plots
        from yawdesign.output.targets import Target, checked_targets

        tables = Target("--csv", csv, (".csv",), force), Target("--npz", npz, (".npz",), force)
        targets = (*tables, Target("--plot", plot, plots.PICTURES, force))
        to_csv, to_npz, to_plot = checked_targets(targets, [file, track])
        plots.check_pictures(to_plot)
        problem = _read(file)
        _check_response(problem, response, plot)
        with _progress() as progress:
            from yawdesign.response.run.simulate import simulate as run
            from yawdesign.response.track.tracks import shaped

            result = run(
                problem,
                shaped(track, wavelength=wavelength, amplitude=amplitude),
                speed=speed or None,
                duration=duration,
                length=length,
                step=step,
                start=start,
                offset=offset,
                band=band,
                seed=seed,
                progress=progress,
            )
        if to_plot:
            plots.write_picture(plots.plot(result, response=response or "y_b"), to_plot, replace=force)
        if to_csv:
            histories.write_csv(result, to_csv, replace=force)
        if to_npz:
            histories.write_npz(result, to_npz, replace=force)
        _show(result, as_json, "simulation_tables", "yawdesign.output.response_tables")
    raise typer.Exit(_code(result.checked, result.settles))


def _check_response(problem: "Problem", response: str | None, plot: str | None) -> None:
    from yawdesign.problem import ProblemError
    from yawdesign.problem.table import as_choice
    from yawdesign.response.run.simulate import response_names

    if response is None:
        return
    if not plot:
        raise ProblemError("--response: chooses what --plot draws: give --plot too")
    try:
        as_choice(response, response_names(problem))
    except ProblemError as error:
        raise error.under("--response") from None


@app.command()
def modes(
    file: ProblemFile,
    over: Annotated[
        str, typer.Option(metavar="NAME=LOW:HIGH:N[:log]", help="Follow the modes, such as 'v=50 km/h:450 km/h:80'.")
    ] = "",
    plot: Annotated[str | None, typer.Option(metavar="FILE", help="Draw the mode, or with --over the paths.")] = None,
    of: Annotated[
        str, typer.Option(help="What --plot draws with --over: root_locus (default), damping_ratio or frequency.")
    ] = "",
    animate: Annotated[str, typer.Option(metavar="MODE", help="Which mode is drawn; the slowest if not given.")] = "",
    to: Annotated[
        str | None, typer.Option(metavar="FILE", help="Show the mode in motion: a .gif or .svg file.")
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Show all modes by name: frequency, damping, what takes part; follow them over speed or any parameter."""
    with _mistakes_shown():
        from yawdesign.output import plots
        from yawdesign.output.targets import Target, checked_targets

        pictures = Target("--plot", plot, plots.PICTURES, force), Target("--to", to, plots.ANIMATIONS, force)
        to_plot, to_animate = checked_targets(pictures, [file])
        plots.check_pictures(to_plot, to_animate)
        _check_modes(over=over, plot=plot, of=of, animate=animate, to=to)
        problem = _read(file)
        if over:
            result: Any = import_module("yawdesign.response.modes.followed_modes").follow_modes(problem, **_axis(over))
        else:
            result = import_module("yawdesign.response.modes.named_modes").modes(problem)
        if to_plot:
            options: dict[str, Any] = {"of": of or "root_locus"} if over else {"mode": animate or None}
            plots.write_picture(plots.plot(result, **options), to_plot, replace=force)
        if to_animate:
            moving = import_module("yawdesign.output.animation").animate
            moving(result, to_animate, mode=animate or None, replace=force)
        _show(result, as_json, "followed_tables" if over else "modes_tables", "yawdesign.output.mode_tables")
    raise typer.Exit(_code(result.checked, bool(over) or result.stable))


def _check_modes(*, over: str, plot: str | None, of: str, animate: str, to: str | None) -> None:
    """Check that every option has something to act on."""
    from yawdesign.output.mode_plots import QUANTITIES
    from yawdesign.problem import ProblemError
    from yawdesign.problem.diagnostics import Mistakes
    from yawdesign.problem.table import as_choice

    mistakes = Mistakes()
    with mistakes.under("--of"):
        as_choice(of or QUANTITIES[0], QUANTITIES)
        if of and not (over and plot):
            raise ProblemError("chooses what --plot draws with --over: give both")
    with mistakes.under("--animate"):
        if animate and not (plot or to):
            raise ProblemError("chooses which mode --plot or --to shows: give one of them")
    with mistakes.under("--over"):
        if over and (to or animate):
            raise ProblemError("--animate and --to show a mode at one place: leave out --over")
    mistakes.report()


def _axis(text: str) -> dict[str, Any]:
    """Return a parameter with its values, from NAME=LOW:HIGH:N, or NAME=LOW:HIGH:N:log for geometric steps."""
    from yawdesign.problem import PARAMETERS, ProblemError
    from yawdesign.problem.diagnostics import unknown_key
    from yawdesign.study.axes import ROWS, read_range

    name, _, values = text.partition("=")
    try:
        if name not in (allowed := ("v", *PARAMETERS)):
            raise ProblemError(f"{name} {unknown_key(name, allowed)}")
        return {name: read_range(values, ROWS[name])}
    except ProblemError as error:
        raise error.under(f"--over {text}") from None


@contextmanager
def _progress() -> Iterator[Any]:
    """Show what is going on on standard error, if a person is looking."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda text, part: None
        return
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("starting", total=1.0)
        yield lambda text, part: bar.update(task, description=text, completed=part)


@app.command()
def export(
    file: ProblemFile,
    to: Annotated[str, typer.Option(metavar="DIR", help="Folder to write; new or empty.", show_default=False)],
    inputs: Annotated[
        str | None, typer.Option(metavar="C_s,K_m,v", help="Parameters that stay inputs; all, if not given.")
    ] = None,
    only: Annotated[
        str | None, typer.Option(metavar="NAMES", help="Functions, or kinds of files, to write; all.")
    ] = None,
    formats: Annotated[str | None, typer.Option(metavar="NAMES", help="Kinds of files to write; all.")] = None,
    prefix: Annotated[
        str, typer.Option(metavar="NAME", help="What C files and symbols begin with; another for each export.")
    ] = "yawdesign",
    force: Annotated[bool, typer.Option("--force", help="Replace the files of an earlier export.")] = False,
    as_json: AsJson = False,
) -> None:
    """Write the model as functions for C, MATLAB and CasADi, with a manifest of their inputs and outputs."""
    with _mistakes_shown():
        problem = _read(file)
        from yawdesign.exports.write import export as write

        result = write(problem, to, inputs=inputs, only=only, formats=formats, prefix=prefix, force=force)
        for note in result.notes:
            tell(f"note: {note}")
        _show(result, as_json, "export_tables")


@app.command()
def new(
    file: Annotated[str, typer.Argument(help="The file to write.")] = "problem.yaml",
    kind: Annotated[str, typer.Option(help="power or trailer.")] = "power",
    force: Annotated[bool, typer.Option("--force", help="Replace files that exist.")] = False,
) -> None:
    """Write a commented problem file to start from, and beside it the schema that editors use."""
    from yawdesign.output.targets import Target, checked_targets
    from yawdesign.problem import SCHEMA_FILE, ProblemError, starter
    from yawdesign.problem.whole_files import write_whole

    with _mistakes_shown():
        if kind not in ("power", "trailer"):
            raise ProblemError(f"--kind {kind} is not one of power, trailer")
        path = Path(file)
        if path.name == SCHEMA_FILE:
            raise ProblemError(f"{file}: the schema is written under this name beside the problem: choose another name")
        checked_targets([Target("", file, replaced=force)], [])
        write_whole(path, starter(kind).encode(), replace=force)
        schema = path.with_name(SCHEMA_FILE)
        beside = f" and {schema}" if path.is_file() and _write_schema(schema, force) else ""
        write_answer(f"wrote {file}{beside}; next: yawdesign optimise {file}\n")


def _write_schema(path: Path, force: bool) -> bool:
    """Return whether the schema was written; another file of that name stays, with a note, unless `force` is given."""
    from yawdesign.problem.whole_files import write_whole

    content = _schema_text().encode()
    if not path.exists() or force:
        write_whole(path, content, replace=force)
        return True
    if path.read_bytes() != content:
        tell(f"note: {path} was there and is kept; it is not the schema of this version, which --force puts there")
    return False


@app.command()
def check(file: ProblemFile) -> None:
    """List every mistake of a problem file, and doubtful values."""
    with _mistakes_shown():
        _read(file)
        write_answer(f"{file}: no errors\n")


@app.command()
def schema() -> None:
    """Print the JSON Schema of the problem file, for editors."""
    with _mistakes_shown():
        typer.echo(_schema_text(), nl=False)


def _schema_text() -> str:
    from yawdesign.problem import schema as problem_schema

    return json.dumps(problem_schema(), indent=2, ensure_ascii=False) + "\n"


@app.callback(invoke_without_command=True)
def _version(
    version: Annotated[bool, typer.Option("--version", help="Print the version.", is_eager=True)] = False,
) -> None:
    if version:
        from yawdesign import __version__

        typer.echo(f"yawdesign {__version__}")
        raise typer.Exit


def main() -> None:
    """Run the command line; no request to stop, and no answer that cannot be written, ends it with a traceback."""
    open_streams()
    os.environ["MPLBACKEND"] = "agg"  # pictures are files: no window, whatever a user has set
    from yawdesign.problem.stopping import ignore_requests, watched

    try:
        with watched():
            app()
    except KeyboardInterrupt as error:
        ignore_requests()
        tell("interrupted")
        sys.exit(_stopped(error))
    except OSError as error:  # of the texts that the library of the command line writes itself, such as --help
        discard(sys.stdout)
        tell(f"error: {ANSWER} could not be written: {error.strerror}")
        sys.exit(BAD_INPUT)


if __name__ == "__main__":
    main()
