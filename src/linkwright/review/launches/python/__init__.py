"""Read Python launch files without running them."""
