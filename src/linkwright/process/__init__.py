"""Process-wide functions for arguments, standard streams, Ctrl-C and the event loop."""
