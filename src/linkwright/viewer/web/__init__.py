"""The web server of a viewer: admission, the open pages, and the queue of data for each."""
