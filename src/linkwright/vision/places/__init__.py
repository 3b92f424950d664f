"""Where the things are that were found in a picture, which is which from picture to picture, and how to get there."""
