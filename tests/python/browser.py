"""Where Chromium is; the tests that look at a page as a person does fail where there is none."""

import shutil
from pathlib import Path

import pytest
from playwright.sync_api import Playwright, sync_playwright

REMEDY = "no Chromium is installed; `bash toolchain/setup.sh build test`, as `make test` does, installs one"


def find(playwright: Playwright) -> str:
    """The path of the browser: that of the machine, else the one that Playwright has brought; empty without any."""
    names = ("chromium", "chromium-browser", "google-chrome")
    brought = playwright.chromium.executable_path
    return next(filter(None, map(shutil.which, names)), brought if Path(brought).is_file() else "")


def found(playwright: Playwright) -> str:
    """The same; fails the test without any."""
    path = find(playwright)
    if not path:
        pytest.fail(REMEDY, pytrace=False)
    return path


if __name__ == "__main__":
    with sync_playwright() as started:
        path = find(started)
    print(path or REMEDY)
    raise SystemExit(not path)
