"""The process: its arguments, standard streams, Ctrl-C, event loop, processors and the unit of its clocks."""
