"""The training, evaluation and export of networks on labeled images, with a card.

Only the training itself needs PyTorch.
"""
