"""What can go wrong with a user's input, one class per subsystem.

Each is raised at the edge, with a message of one line that names the place (file, row, key or
time), what was expected and what was found. The command line turns any of them into that line
and exit code 3.
"""

from __future__ import annotations


class SmdError(Exception):
    """Input that Spatial Motion Doodles cannot use; the message is one line for the user."""


class DoodleError(SmdError):
    """A trajectory that is not a doodle: wrong shapes, times that do not increase, no movement."""


class RecordingError(SmdError):
    """A recording file that cannot be read."""


class CaptureError(SmdError):
    """Tracked devices that cannot be recorded: no runtime, no such device, nowhere to write."""


class PatternError(SmdError):
    """A pattern that does not parse; ``position`` is the offending character's index."""

    def __init__(self, message: str, position: int | None = None) -> None:
        super().__init__(message)
        self.position = position


class CharacterError(SmdError):
    """A skeleton, clip, mesh or character whose parts do not fit each other."""


class LibraryError(SmdError):
    """A library folder that is missing, incomplete or not ours."""


class ImportedFileError(SmdError):
    """A BVH, glTF or USD file from which no character or clip can be taken."""


class ScoreError(SmdError):
    """A Score that does not fit its schema, its recording or its library."""


class TransferError(SmdError):
    """A Score that cannot be acted out."""


class ExportError(SmdError):
    """An output that cannot be written."""


class LearningError(SmdError):
    """Examples from which no gesture can be learned; ``example`` is the index of the one at fault.

    None where the fault is not that of one example.
    """

    def __init__(self, message: str, example: int | None = None) -> None:
        super().__init__(message)
        self.example = example
