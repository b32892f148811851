"""The terminal of whoever runs the tests must not colour what they read."""

import os

for each in ("FORCE_COLOR", "CLICOLOR_FORCE"):
    os.environ.pop(each, None)
