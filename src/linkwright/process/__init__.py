"""Functions for the whole process.

They concern arguments, standard streams, Ctrl-C, the event loop and forked programs.
"""
