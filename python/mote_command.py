"""The command `mote` of a wheel: the program that lies beside the module. Imports nothing of the package, which would
take several times as long as the program's own start."""
import importlib.util
import os
import sys


def main():
    folder = importlib.util.find_spec("mote").submodule_search_locations[0]
    for program in (os.path.join(folder, "mote"), os.path.join(folder, "..", "..", "bin", "mote")):  # a wheel, a build
        if os.access(program, os.X_OK) and os.path.isfile(program):
            os.execv(program, ["mote", *sys.argv[1:]])
    sys.exit("mote: the command was not found beside the package")
