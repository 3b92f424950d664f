"""The controller manager, which loads, switches and updates controllers."""
