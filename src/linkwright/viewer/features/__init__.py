"""What pages can ask for besides displays, a module or a package each."""
