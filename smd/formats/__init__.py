"""Recording files: one module per format, all read into our convention.

A format is a module with ``matches(head)``, which knows its files by their content, and
``read(text, name)``, which returns the poses as they stand in the file. Formats that are not plain
text (Beat Saber Open Replay, USD) are known by their suffix and have ``read(path, name)``. What
all share (frames, checks, dropouts) is done once, in `smd.formats.reading`.
"""

from smd.formats.frame import Mount, SourceFrame
from smd.formats.native import write_recording
from smd.formats.reading import SUFFIXES, read_recording

__all__ = ["SUFFIXES", "Mount", "SourceFrame", "read_recording", "write_recording"]
