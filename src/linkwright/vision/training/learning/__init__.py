"""The code that imports PyTorch.

Call `linkwright.vision.training.library.need_pytorch` before importing it.
"""
