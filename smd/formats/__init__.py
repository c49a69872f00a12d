"""Recording files: one module per format, all read into our convention.

A module ends with its `RecordingFormat`: suffixes, how a text of its own is known, and what reads
the poses as they stand in a file. `smd.formats.reading` lists them, and does once what all share:
frames, checks, dropouts. What is wrong with a file is raised as a `Fault`, which knows the place;
reading adds the file's name.
"""

from smd.formats.frame import Mount, SourceFrame
from smd.formats.native import write_recording
from smd.formats.reading import SUFFIXES, read_recording

__all__ = ["SUFFIXES", "Mount", "SourceFrame", "read_recording", "write_recording"]
