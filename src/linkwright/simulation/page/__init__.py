"""Page features of simulated worlds: controlling time, moving models, editing the world."""
