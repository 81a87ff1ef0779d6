"""The commands of `stillspin`."""

from __future__ import annotations

import typer

from stillspin.commands import (
    board,
    campaign,
    campaigns,
    can_bus,
    commission,
    console,
    explain,
    flash,
    hil,
    image,
    loader,
    monitor,
    motor,
    params,
    round_trips,
    schema,
    scope,
    startup,
    tune,
)


def register(app: typer.Typer) -> None:
    """Add them to the command line."""
    app.command(name="run")(campaigns.run)
    app.command(name="reproduce")(campaigns.reproduce)
    app.command(name="drift")(campaigns.drift)
    app.command(name="explain")(explain.explain)
    app.command(name="commission")(commission.commission)
    app.command(name="board")(board.board)
    app.command(name="startup-matrix")(startup.startup_matrix)
    app.command(name=round_trips.NAME)(round_trips.round_trips)
    app.command(name=campaign.NAME, epilog=campaign.EXAMPLES)(campaign.campaign)
    app.add_typer(params.app, name="params")
    app.add_typer(motor.app, name="motor")
    app.add_typer(image.app, name="image")
    app.command(name="console")(console.console)
    app.command(name="schema")(schema.schema)
    app.command(name="scope")(scope.scope)
    app.command(name="monitor")(monitor.monitor)
    app.command(name="can")(can_bus.bus)
    app.command(name="tune")(tune.tune)
    app.command(name="hil")(hil.hil)
    app.command(name="flash")(flash.flash)
    app.command(name="demo-image")(flash.demo_image)
    app.command(name="loader")(loader.loader)
