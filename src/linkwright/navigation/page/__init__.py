"""Page features of navigation: the panel that controls nav2, and the outcome of goals."""
