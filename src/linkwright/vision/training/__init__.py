"""Train networks on labelled images, evaluate them, and export them with a card.

Only the training itself needs PyTorch.
"""
