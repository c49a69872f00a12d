"""Capture: from tracked devices to recordings, as they move.

A source (`smd.capture.source`) says which devices there are and yields their poses; OpenVR and
recordings played back are two. What a source yields goes to the recorder, which loses nothing,
and to recognition.
"""
