"""Page features of navigation: starting and stopping it, and the outcome of goals."""
