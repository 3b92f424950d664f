"""``python -m linkwright``."""

from linkwright.cli.main import main

raise SystemExit(main())
