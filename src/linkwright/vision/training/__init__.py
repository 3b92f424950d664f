"""Training networks: on labelled pictures, evaluated, exported with a card. Only training itself needs PyTorch."""
