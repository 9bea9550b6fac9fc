"""The command line: parses, calls, prints and sets the exit code."""

import os
import sys
from typing import Annotated

import typer

from yawdesign.cli.answering import code_of, told
from yawdesign.cli.choices import choose
from yawdesign.cli.designs import critical_speed, design, optimise, stability
from yawdesign.cli.distributions import uncertainty
from yawdesign.cli.files import check, export, new, schema
from yawdesign.cli.reports import report
from yawdesign.cli.reproductions import reproduce
from yawdesign.cli.responses import modes, simulate
from yawdesign.cli.sweeps import sweep
from yawdesign.cli.trade_offs import trade_off
from yawdesign.output.streams import ANSWER, discard, open_streams, tell

app = typer.Typer(
    help="Yaw damper design for motor bogies: hunting stability, curving limit and optimum.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
COMMANDS = (
    *(stability, critical_speed, design, optimise, choose, trade_off, uncertainty),
    *(sweep, simulate, modes, report, reproduce, export, new, check, schema),
)
for command in COMMANDS:
    app.command()(command)
app.command("optimize", hidden=True)(optimise)


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
    try:
        from yawdesign.problem.stopping import watched

        with watched():
            app()
    except KeyboardInterrupt as error:
        from yawdesign.problem.stopping import ignore_requests

        ignore_requests()
        tell(told(error))
        sys.exit(code_of(error))
    except OSError as error:  # of the texts that the library of the command line writes itself, such as --help
        discard(sys.stdout)
        tell(f"error: {ANSWER} could not be written: {error.strerror}")
        sys.exit(code_of(error))
