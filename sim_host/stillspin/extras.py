"""Packages that an installation may do without, and what is said where one is wanted and missing."""

from __future__ import annotations

import importlib
import importlib.util
from typing import Any

from stillspin.errors import InputError

EXTRA_OF = {
    "jinja2": "virtual",
    "jsonschema": "virtual",
    "matplotlib": "plots",
    "pandas": "tables",
    "pyarrow": "tables",
    "scipy": "maps",
}
"""Package -> the extra in sim_host/pyproject.toml that brings it."""


def remedy(extra: str) -> str:
    """How to get an extra; on no public index is there a stillspin, so it says where the wheels come from."""
    return (
        f"pip install --find-links dist 'stillspin[{extra}]' where dist is what 'make wheel' made, "
        "or 'make build' in the sources"
    )


def has(package: str) -> bool:
    """Whether a package is there."""
    return importlib.util.find_spec(package) is not None


def need(module: str) -> Any:
    """A module of one of these packages.

    Args:
        module: its name, such as pyarrow.parquet.

    Raises:
        InputError: the package is not installed; says how to.
    """
    package = module.partition(".")[0]
    if not has(package):
        raise InputError(f"this needs {package}, which is not installed: {remedy(EXTRA_OF[package])}")
    return importlib.import_module(module)
