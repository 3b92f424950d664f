"""Properties that several displays have, and how their values are read."""
