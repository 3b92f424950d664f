"""The programs and Python modules of packages: what they are, and what they need around them to run."""
