"""A drive as a Python object: parameters in user's units, commands, scope, stream.

from stillspin.drive import Drive

with Drive.open("serial:///dev/ttyUSB0") as drive:
drive.set("speed_ramp", 1000)
with drive.running(600):
print(drive.status())
"""

from stillspin.drive.commissioning import Identified, Report
from stillspin.drive.drive import Drive
from stillspin.drive.log import Log
from stillspin.drive.look import Look, Outcome
from stillspin.drive.scope import Capture, Channel, Trigger
from stillspin.drive.state import Fault, Status
from stillspin.drive.stream import Sample, Stream
from stillspin.drive.table import Parameter, Signal, Table
from stillspin.drive.values import ConflictWarning

__all__ = [
    "Capture",
    "Channel",
    "ConflictWarning",
    "Drive",
    "Fault",
    "Identified",
    "Log",
    "Look",
    "Outcome",
    "Parameter",
    "Report",
    "Sample",
    "Signal",
    "Status",
    "Stream",
    "Table",
    "Trigger",
]
