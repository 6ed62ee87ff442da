"""The `lagnet` command: names every subcommand, imports only the one that is called, and turns errors into exit codes.

Exit codes: 0 done; 1 a check that the user asked for failed (`raise typer.Exit(1)`); 2 bad input or usage;
3 interrupted; 70 a fault of lagnet itself, with its trace.

A subcommand is one file `lagnet/cli/NAME.py` that holds either `command`, a function with typer annotations, or `app`,
a `typer.Typer` with subcommands of its own, plus one line in `COMMANDS`; its helpers stand in `parts` and `shared`.
"""

from __future__ import annotations

import importlib
import sys
import traceback
from collections.abc import Sequence
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

from lagnet.cli.shared.many_values import repeat_options
from lagnet.errors import LagnetError

COMMANDS = {
    "demo": "Hide an effect in a simulated arm, diagnose it, open the envelope and compare.",
    "simulate": "Move a robot in PyBullet, with known effects added, and write recordings.",
    "train": "Learn a dynamics model from recordings.",
    "decompose": "Split the torque into inertial, Coriolis, gravity and residual parts.",
    "check": "Hold a model or robot against physics; exit code 1 when a check fails.",
    "diagnose": "Say where recordings and robot differ, and name the physics that was left out.",
    "export": "Write a corrected model for MuJoCo, PyBullet, URDF, SDF, USD, Drake or Isaac Lab.",
    "replay": "Run recordings through a model in MuJoCo or PyBullet, before and after correction.",
    "compare": "Say which of several parameter sets explains recordings better, joint by joint.",
    "track": "Follow the physics of many robots over time: what changed, when, and what is out of family.",
    "data": "Say what a log holds; list and fetch the public data sets that tests and studies use.",
}
DONE, CHECK_FAILED, BAD_INPUT, INTERRUPTED, FAULT = 0, 1, 2, 3, 70
HELP = (
    "Find the physics that a robot's simulation leaves out. "
    "ROBOT is a URDF or MJCF path, a name of example-robot-data, or a folder written by train or diagnose."
)
# typer ships its own copy of click in newer versions and uses the installed one in older: ask typer's own exception.
ClickException: Any = next(base for base in typer.BadParameter.__mro__ if base.__name__ == "ClickException")


class LazyCommands(TyperGroup):
    """Shows one line of help for every subcommand, and imports only the one that is called."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Names in the order in which a newcomer meets them."""
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """A stand-in that holds the name and its line of help: enough for `--help` and for spelling hints."""
        return self.commands.get(cmd_name)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Import the subcommand that was asked for."""
        name, stand_in, rest = super().resolve_command(ctx, args)
        return name, stand_in and load_command(str(name)), rest

    def invoke(self, ctx: Any) -> Any:
        """Run the subcommand; Ctrl-C becomes exit code 3 with what was finished kept by the subcommand."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            print("lagnet: interrupted", file=sys.stderr)
            raise typer.Exit(INTERRUPTED) from None


def load_command(name: str) -> Any:
    """The command object of `lagnet/cli/NAME.py`.

    Raises:
        LagnetError: this installation has no such file.
    """
    module_name = f"lagnet.cli.{name}"
    try:
        module = importlib.import_module(module_name)
    except ModuleNotFoundError as error:
        if error.name != module_name:
            raise
        raise LagnetError(
            f"the command {name} is not part of this installation", next_step="install the newest lagnet"
        ) from None
    if hasattr(module, "app"):
        return typer.main.get_command(module.app)
    app = typer.Typer(add_completion=False, rich_markup_mode="markdown")
    app.command(name=name, short_help=COMMANDS[name])(module.command)
    return typer.main.get_command(app)


def _version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        print(f"lagnet {version('lagnet')}")
        raise typer.Exit


def _top(version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Print it.")) -> None:
    pass


def build() -> LazyCommands:
    """The whole command line as one command object."""
    app = typer.Typer(
        cls=LazyCommands, help=HELP, rich_markup_mode="markdown", context_settings={"max_content_width": 120}
    )
    app.callback()(_top)
    group: Any = typer.main.get_command(app)
    group.commands = {name: TyperCommand(name, help=text) for name, text in COMMANDS.items()}
    return group


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command line; errors of the user become one line on standard error.

    Args:
        arguments: words after `lagnet`; those of the process where None.

    Returns:
        The exit code, see the module's docstring.
    """
    words = repeat_options(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    try:
        return build().main(words, prog_name="lagnet", standalone_mode=False) or DONE
    except LagnetError as error:
        return _complain(str(error))
    except ClickException as error:
        return _complain_of_usage(error)
    except typer.Abort:
        return _complain("interrupted", INTERRUPTED)
    except MemoryError:
        return _complain("not enough memory for this input; give fewer or shorter recordings or fewer joints")
    except BrokenPipeError:
        # The reader of our output went away (`lagnet ... | head`): nothing is wrong with the work done.
        sys.stdout = None  # type: ignore[assignment]
        return DONE
    except OSError as error:
        return _complain(f"{error.filename or 'file system'}: {error.strerror or error}")
    except Exception:
        # Python's own exit code for this is 1, which a script would take for a failed check.
        traceback.print_exc()
        return _complain("this is a fault of lagnet, not of your input; please report it with the lines above", FAULT)


def _complain_of_usage(error: Any) -> int:
    message, ctx = error.format_message().strip().rstrip("."), getattr(error, "ctx", None)
    if not message:
        return BAD_INPUT  # a group called without a subcommand has shown its help
    return _complain(message + (f"; see {ctx.command_path} --help" if ctx else ""))


def _complain(message: str, code: int = BAD_INPUT) -> int:
    print("lagnet: " + " ".join(message.split()), file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
