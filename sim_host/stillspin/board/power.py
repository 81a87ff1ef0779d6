"""Switching a virtual board on."""

from __future__ import annotations

from stillspin import core
from stillspin.cases.profile import Changes, Profile, merged
from stillspin.core_board import NativeBoard
from stillspin.errors import InputError

_FAST: core.Plant = {"solver": {"method": "rk4"}}
"""Unless profile or user say otherwise: real time matters more here than the last digit."""


def power(
    native: core.NativeCore, chosen: Profile, changes: Changes, seed: int, image: core.Blocks | None = None
) -> NativeBoard:
    """A virtual board that has just been switched on, with the firmware or a chip that executes an image.

    Raises:
        InputError: a plant or parameters that cannot be.
    """
    parameters = {**chosen.parameters, **changes.parameters}
    try:
        native.check_parameters(parameters)
        plant = merged(_FAST, chosen.plant, changes.plant)
        if image:
            return native.VirtualBoard(plant=plant, parameters={}, seed=seed, image=image)
        return native.VirtualBoard(plant=plant, parameters=parameters, seed=seed)
    except ValueError as error:
        raise InputError(str(error)) from error
