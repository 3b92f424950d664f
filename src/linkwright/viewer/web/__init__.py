"""The web server of a viewer: who may come in, the pages that are open, and what waits to be sent to each."""
