"""Commands of `stillspin` in this process: to start another one takes longer than most of them."""

from typer.testing import CliRunner

from stillspin import cli


def stillspin(*words):
    """What a command printed, and its exit status."""
    done = CliRunner().invoke(cli.app, [str(word) for word in words])
    if done.exception and not isinstance(done.exception, SystemExit):
        raise done.exception
    return done
