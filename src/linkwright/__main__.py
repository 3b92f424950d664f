"""Entry point of ``python -m linkwright``."""

from linkwright.cli import main

raise SystemExit(main())
