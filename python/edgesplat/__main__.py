"""``python3 -m edgesplat render ...`` runs the program edgesplat that the package contains."""

import os
import sys

program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "edgesplat")
try:
    os.execv(program, ["edgesplat", *sys.argv[1:]])
except OSError as error:
    sys.exit(f"edgesplat: error: {program}: {error.strerror}; expected the program beside the package")
