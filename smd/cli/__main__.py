"""``python -m smd.cli``: the command line where the ``smd`` script is not on the path."""

from smd.cli.app import main

main()
