"""The training, evaluation and export of networks on labelled images, with a card.

Only the training itself needs PyTorch.
"""
