"""``python -m linkwright.cli``."""

from linkwright.cli.main import main

raise SystemExit(main())
