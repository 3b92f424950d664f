"""``python -m linkwright``."""

from linkwright.cli import main

raise SystemExit(main())
