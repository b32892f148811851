"""`python -m mjbeer` does what the command `mjbeer` does."""

import sys

from mjbeer.cli.app import main

if __name__ == "__main__":
    sys.exit(main())
