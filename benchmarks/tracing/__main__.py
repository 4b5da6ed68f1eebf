"""`python -m benchmarks.tracing`, the same as `python -m benchmarks tracing`."""

import sys

from benchmarks.tracing.run import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
