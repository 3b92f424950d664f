"""Initial weights from a network that `linkwright vision train` exported.

The export folds the normalisation into each convolution. This module splits it into two layers again that compute the
same result. The file lacks the statistics of the normalisation, so they are measured with images.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import onnx
import torch
from onnx import numpy_helper
from torch import Tensor, nn

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, foreign, missing_file_hint, phrase
from linkwright.vision.detectors.class_names import names_in_metadata
from linkwright.vision.training.learning.network import Convolution, Network

_SHORTEST = 1e-12  # the minimum norm of a kernel, which avoids a division by zero


def load_weights(network: Network, names: Sequence[str], path: Path, images: Iterable[Tensor]) -> None:
    """Load the weights of an ONNX file into a network.

    Classes are matched by name. Weights for a class that the file lacks are left unchanged.

    Args:
        network: the network to change. With the classes of the file it computes the same boxes and logits, up to a
            shift that the export has added. It is in evaluation mode afterwards.
        names: the names of the network's classes.
        path: the path of the ONNX file.
        images: the images used to measure layer statistics, shape (batch, 3, height, width).

    Raises:
        LinkwrightError: VISION308, the file cannot be read, or contains a different network.
    """
    known, weights = _read(path)
    layers = _in_order(network.eval())
    channels, wanted = len(weights[0][0]), network.shape.channels
    if len(weights) == len(layers) and channels != wanted:
        reason = phrase("its first layer has {channels} channels, not {wanted}", channels=channels, wanted=wanted)
        raise _unusable(path, reason, phrase("train with `--channels {channels}`", channels=channels))
    scores = [head.scores[-1] for head in network.heads]
    shapes = [(len(known) if layer in scores else len(layer.weight), *layer.weight.shape[1:]) for layer in layers]
    if shapes != [tuple(kernel.shape) for kernel, _ in weights]:
        raise _unusable(path, phrase("it is not a network of `linkwright vision train`"))
    blocks = {block.convolution: block for block in network.modules() if isinstance(block, Convolution)}
    with torch.no_grad():
        for layer, (kernel, bias) in zip(layers, weights, strict=True):
            if layer in scores:
                for row, name in enumerate(names):
                    if name in known:
                        layer.weight[row], layer.bias[row] = kernel[known.index(name)], bias[known.index(name)]
            else:
                layer.weight.copy_(kernel)
                _offset(blocks[layer].norm if layer in blocks else layer, bias)
        _normalize(network, list(blocks.values()), images)


def _read(path: Path) -> tuple[tuple[str, ...], list[tuple[Tensor, Tensor]]]:
    """Return the class names, and the kernel and bias of each convolution in execution order."""
    try:
        model = onnx.load(path, load_external_data=False)
        stored = {tensor.name: numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
    except FileNotFoundError:
        raise _unusable(path, phrase("it does not exist"), missing_file_hint(path)) from None
    except OSError as error:
        raise _unusable(path, foreign(error.strerror or error)) from None
    except Exception:  # noqa: BLE001 - protobuf and ONNX raise many kinds
        raise _unusable(path, phrase("it is not an ONNX file")) from None
    stored.update({step.output[0]: stored[step.input[0]] for step in model.graph.node if step.input[:1]
                   and step.op_type == "Cast" and step.input[0] in stored})  # fmt: skip
    metadata = {metadata_prop.key: metadata_prop.value for metadata_prop in model.metadata_props}
    known = names_in_metadata(metadata.get("names", ""))
    inputs = [step.input[1:] for step in model.graph.node if step.op_type == "Conv"]
    if known is None or not inputs or not all(len(pair) == 2 and set(pair) <= stored.keys() for pair in inputs):
        raise _unusable(path, phrase("it is not a network of `linkwright vision train`"))
    pairs = [(torch.tensor(stored[kernel]).float(), torch.tensor(stored[bias]).float()) for kernel, bias in inputs]
    return known, pairs


def _in_order(network: Network) -> list[nn.Conv2d]:
    """Return the convolutions in execution order."""
    found: list[nn.Conv2d] = []
    layers = [module for module in network.modules() if isinstance(module, nn.Conv2d)]
    hooks = [module.register_forward_hook(lambda layer, _, __: found.append(layer)) for module in layers]
    with torch.no_grad():
        network(torch.zeros(1, 3, 32, 32, device=layers[0].weight.device))
    for hook in hooks:
        hook.remove()
    return found


def _offset(layer: nn.Conv2d | nn.BatchNorm2d, bias: Tensor) -> None:
    """Set the bias of a layer; make a normalisation add nothing but this bias."""
    layer.bias.copy_(bias)
    if isinstance(layer, nn.BatchNorm2d):
        layer.weight.fill_(1.0)
        layer.running_mean.zero_()
        layer.running_var.fill_(1.0 - layer.eps)


def _normalize(network: Network, blocks: Sequence[Convolution], images: Iterable[Tensor]) -> None:
    """Move statistics and kernel norms into the normalisations, without changing the results.

    Afterwards the kernel of each output has norm 1, because the optimizer's steps all have the same length.
    """
    sums = {block.norm: torch.zeros(3, block.norm.num_features, dtype=torch.float64) for block in blocks}

    def measure(layer: nn.BatchNorm2d, given: tuple[Tensor]) -> None:
        values = given[0].double().transpose(0, 1).flatten(1).cpu()
        sums[layer] += torch.stack((torch.full((len(values),), values.shape[1]), values.sum(1), (values**2).sum(1)))

    hooks = [block.norm.register_forward_pre_hook(measure) for block in blocks]
    for image in images:
        network(image)
    for hook in hooks:
        hook.remove()
    for block in blocks:
        kernel, norm = block.convolution.weight, block.norm
        length = kernel.flatten(1).norm(dim=1).clamp_min(_SHORTEST)
        count, total, squares = sums[norm]
        mean = total / count
        variance = (squares / count - mean**2).clamp_min(0.0)
        mean, variance = mean.to(kernel), variance.to(kernel)
        kernel.div_(length[:, None, None, None])
        norm.running_mean.copy_(mean / length)
        norm.running_var.copy_(variance / length**2)
        norm.weight.copy_((variance + norm.eps * length**2).sqrt())
        norm.bias.add_(mean)


def _unusable(path: Path, reason: Phrase, hint: Phrase | None = None) -> LinkwrightError:
    message = phrase("cannot start from the weights of '{path}': {reason}", path=display_path(path), reason=reason)
    return LinkwrightError(Diagnostic("VISION308", message, hint=hint))
