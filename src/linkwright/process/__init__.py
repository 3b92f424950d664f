"""The process: its arguments, standard streams, Ctrl-C, event loop and processors."""
