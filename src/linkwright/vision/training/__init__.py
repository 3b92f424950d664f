"""Training networks: on labelled images, evaluated, exported with a card. Only training itself needs PyTorch."""
