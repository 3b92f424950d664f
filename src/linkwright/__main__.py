"""``python -m linkwright``."""

from linkwright.cli.command import main

raise SystemExit(main())
