"""Capture: recording tracked devices while they move.

A source (`smd.capture.source`) lists the devices and yields their poses; OpenVR and the replay of
recordings are two. Its frames go to the recorder, which loses nothing, and to recognition.
"""
