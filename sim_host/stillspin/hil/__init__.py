"""Host in the loop: a board steps through a run period by period and is compared with the virtual drive."""

from stillspin.hil.loop import Difference, Loop, LoopResult, Play

__all__ = ["Difference", "Loop", "LoopResult", "Play"]
