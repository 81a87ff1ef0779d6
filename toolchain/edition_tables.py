"""The tables of an edition of the firmware: what is found in them, and as what C has it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """A table of an edition, as C has it."""

    type: str
    header: str
    form: str = "list"  # with NULL behind the last one; "one" and no more, or NULL; "places": by number, NULL between
    least: int = 0  # places at least, or rows
    arrays: bool = False  # its rows are arrays
    prefix: str = "edition_"
    asked_by: str = ""  # the feature that alone asks it: without that one it has no rows

    def text(self, name: str, rows: list[tuple[int, str]]) -> str:
        """Its definition, of rows with their places.

        Raises:
            ValueError: there has to be a row, and there is none.
        """
        if self.form == "one" and len(rows) < self.least:
            raise ValueError(f"no feature is there for {name}, and no edition works without it")
        refer = "&" if self.type.startswith("const ") and not self.arrays else ""  # functions need none
        if self.form == "one":
            return f"{self.type}* const {self.prefix}{name} = {refer + rows[0][1] if rows else 'NULL'};\n"
        if self.form == "places":
            by_place = dict(rows)
            count = max([self.least, *(place + 1 for place in by_place)])
            cells = [refer + by_place[k] if k in by_place else "NULL" for k in range(count)]
        else:
            cells = [*(refer + row for _, row in rows), "NULL"]
        head = f"{self.type}* const {self.prefix}{name}[] = {{"
        return "\n    ".join([head, *(f"{cell}," for cell in cells)]) + "\n};\n"


def variants_text(places: dict[str, list[int]], count: int) -> str:
    """Which of its places a position source has there, as C has it.

    Args:
        places: of the sources that have several.
        count: of the places of all.

    Raises:
        ValueError: more than one source has several: who asks would take one for the other.
    """
    if len(places) > 1:
        raise ValueError(f"{' and '.join(places)} have several places in position_sources; one source may")
    by_place = {place: k for own in places.values() for k, place in enumerate(own, 1)}
    cells = ", ".join(str(by_place.get(place, 0)) for place in range(count if by_place else 1))
    return f'\n#include "firmware/interfaces/source.h"\n\nconst int16_t position_source_variants[] = {{{cells}}};\n'


SERVICE, STATUS = "firmware/interfaces/service.h", "firmware/api/status.h"
TABLES = {
    "position_sources": Table("const position_source_t", "firmware/interfaces/source.h", "places", prefix=""),
    **{
        name: Table("const position_source_t", "firmware/interfaces/source.h", "one", 1)
        for name in ("start_source", "default_source")
    },
    "drive_states": Table("const state_t", "firmware/interfaces/state.h", "places", 8, prefix=""),
    "start_phases": Table("const phase_t", "firmware/start/phases.h", "places", 9, prefix=""),
    "phase_control": Table("const phase_control_t", "firmware/interfaces/phase_control.h", "one"),
    "config_parts": Table("const config_part_t", "firmware/interfaces/config_part.h"),
    **{name: Table("service_t", SERVICE) for name in ("resets", "power_on", "loading", "starting", "pass")},
    "works": Table("work_t", SERVICE),
    "watch": Table("watch_t", SERVICE, "one"),
    "status_updates": Table("service_t", STATUS),
    "requests": Table("const request_row_t", "firmware/link/request_rows.h", arrays=True, asked_by="link"),
    "suggest": Table("suggest_t", "firmware/console/names.h", "one", asked_by="console"),
    "commands": Table("command_function_t", "firmware/console/commands.h", "places", asked_by="console"),
    "status_lines": Table("const status_line_t", STATUS, asked_by="console"),
    "text_port": Table("const text_port_t", "firmware/interfaces/text_port.h", "one", asked_by="link"),
    "interlocks": Table("interlock_t", "firmware/mode/interlock.h"),
    "current_shares": Table("current_share_t", "firmware/mode/interlock.h"),
}
