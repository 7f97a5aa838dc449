"""The WebSocket client of the Blender add-on."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "plugins", "blender", "mote_render"))
from live_socket import WebSocket, parsed  # noqa: E402, F401
