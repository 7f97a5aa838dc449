"""python -m mote: the command."""
from mote_command import main

main()
