"""The docking server of Nav2."""
