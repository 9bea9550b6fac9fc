"""Commands that show the vehicle in motion: runs over a track, and its modes."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from yawdesign.cli.answering import (
    AsJson,
    Changes,
    Force,
    ProblemFile,
    ended,
    mistakes_told,
    progress_shown,
    read_problem,
    show,
)
from yawdesign.cli.asked_condition import AskedCondition, asked_condition, tell_condition
from yawdesign.cli.pictures import tell_written, write_drawing

if TYPE_CHECKING:
    from yawdesign.problem import Problem


def simulate(
    file: ProblemFile,
    changes: Changes = None,
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
    csv: Annotated[str | None, typer.Option(metavar="FILE", help="Write the time histories as text.")] = None,
    npz: Annotated[str | None, typer.Option(metavar="FILE", help="Write the time histories as NumPy arrays.")] = None,
    plot: Annotated[
        str | None, typer.Option(metavar="FILE", help="Draw responses to a .png, .pdf or .svg file.")
    ] = None,
    response: Annotated[
        list[str] | None,
        typer.Option(help="What --plot draws; y_b, or the car body's accelerations. May be repeated, in one unit."),
    ] = None,
    condition: AskedCondition = None,
    force: Force = False,
) -> None:
    """Run the vehicle over a track: RMS, peaks, whether amplitudes settle, and what its yaw damper has to do."""
    with mistakes_told():
        from yawdesign.output import histories, pictures, plots
        from yawdesign.output.targets import Target, checked_targets

        tables = Target("--csv", csv, (".csv",), force), Target("--npz", npz, (".npz",), force)
        targets = (*tables, Target("--plot", plot, pictures.PICTURES, force))
        to_csv, to_npz, to_plot = checked_targets(targets, [file, track])
        pictures.check_pictures(to_plot)
        under, problem = asked_condition(condition), read_problem(file, changes)
        _check_response(problem, response, plot)
        with progress_shown() as progress:
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
                condition=under,
                progress=progress,
            )
        if to_plot:
            pictures.write_picture(plots.plot(result, response=response or None), to_plot, replace=force)
        if to_csv:
            histories.write_csv(result, to_csv, replace=force)
        if to_npz:
            histories.write_npz(result, to_npz, replace=force)
        tell_written(to_plot, to_csv, to_npz)
        tell_condition(problem, result)
        show(result, as_json)
    raise ended(checked=result.checked, feasible=result.settles)


def _check_response(problem: "Problem", response: list[str] | None, plot: str | None) -> None:
    from yawdesign.problem import ProblemError
    from yawdesign.problem.diagnostics import Mistakes
    from yawdesign.problem.table import as_choice
    from yawdesign.response.run.simulate import response_names

    if not response:
        return
    if not plot:
        raise ProblemError("--response: chooses what --plot draws: give --plot too")
    mistakes = Mistakes()
    for name in response:
        with mistakes.under("--response"):
            as_choice(name, response_names(problem))
    mistakes.report()


def modes(
    file: ProblemFile,
    changes: Changes = None,
    over: Annotated[
        str, typer.Option(metavar="NAME=LOW:HIGH:N[:log]", help="Follow the modes, such as 'v=50 km/h:450 km/h:80'.")
    ] = "",
    plot: Annotated[str | None, typer.Option(metavar="FILE", help="Draw the mode, or with --over the paths.")] = None,
    of: Annotated[
        str, typer.Option(help="What --plot draws with --over: root_locus (default), damping_ratio or frequency.")
    ] = "",
    animate: Annotated[
        str, typer.Option(metavar="MODE", help="Which mode is drawn; the one of least decay rate if not given.")
    ] = "",
    to: Annotated[
        str | None, typer.Option(metavar="FILE", help="Show the mode in motion: a .gif or .svg file.")
    ] = None,
    condition: AskedCondition = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Show all modes by name: frequency, damping, what takes part; follow them over speed or any parameter."""
    with mistakes_told():
        from yawdesign.output import pictures
        from yawdesign.output.targets import Target, checked_targets

        drawn = Target("--plot", plot, pictures.PICTURES, force), Target("--to", to, pictures.ANIMATIONS, force)
        to_plot, to_animate = checked_targets(drawn, [file])
        pictures.check_pictures(to_plot, to_animate)
        _check_modes(over=over, plot=plot, of=of, animate=animate, to=to)
        under, problem = asked_condition(condition), read_problem(file, changes)
        if over:
            from yawdesign.response.modes.followed_modes import follow_modes

            result: Any = follow_modes(problem, condition=under, **_axis(over))
        else:
            from yawdesign.response.modes.named_modes import modes as all_modes

            result = all_modes(problem, condition=under)
        if to_plot:
            along = {"of": of or "root_locus", "target": _required_damping(problem)}
            options: dict[str, Any] = along if over else {"mode": animate or None}
            write_drawing(result, to_plot, force, **options)
        if to_animate:
            from yawdesign.output.animation import animate as write_animation

            write_animation(result, to_animate, mode=animate or None, replace=force)
        tell_written(to_animate)
        tell_condition(problem, result)
        show(result, as_json)
    raise ended(checked=result.checked, feasible=bool(over) or result.stable)


def _required_damping(problem: "Problem") -> float | None:
    """Return the damping ratio that a problem requires without faults [-]."""
    return next((one.wanted for one in problem.requirements if one.name == "damping_ratio"), None)


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
