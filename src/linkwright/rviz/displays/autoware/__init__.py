"""The displays of Autoware's packages, drawn as markers."""
