"""Rolls prisms in PhysX, and writes what became of them for `mjbeer.studies.polygon`.

`python -m tools.physx_prisms` takes a minute. It uses the environment of `make engines`.
"""

import json
import subprocess

from mjbeer.output import files
from mjbeer.studies.can_test import ROLL
from mjbeer.studies.engines.results import question
from mjbeer.studies.polygon import PHYSX
from tools.engines import FOLDER, program


def main() -> None:
    """Write src/mjbeer/studies/physx_prisms.json."""
    python = program(FOLDER / "sapien_can.py").python
    ran = subprocess.run(
        [python, FOLDER / "sapien_prisms.py"],
        input=json.dumps(question(ROLL)),
        capture_output=True,
        text=True,
        check=True,
    )
    files.write(PHYSX, ran.stdout.splitlines()[-1] + "\n")


if __name__ == "__main__":
    main()
