"""The environment of whoever runs the tests must not change what programs write, and when."""

import os

for each in ("FORCE_COLOR", "CLICOLOR_FORCE", "COLUMNS", "PYTHONUNBUFFERED"):
    os.environ.pop(each, None)
