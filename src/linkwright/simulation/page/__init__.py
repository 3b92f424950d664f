"""Page features of simulated worlds: control time, move models, and edit the world."""
