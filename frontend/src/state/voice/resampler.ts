/** The number of zero crossings of the sinc on each side. */
const ZERO_CROSSING_COUNT = 16;
/** The share of the band that is preserved; the filter needs the rest to roll off. */
const PASSBAND_SHARE = 0.92;

/**
 * Converts a stream of samples to another sample rate: each output sample is a sum of the input samples around its
 * time, weighted by a windowed sinc, which also removes frequencies above the new limit.
 */
export class Resampler {
  private readonly step: number;
  private readonly halfWidth: number;
  private readonly cutoff: number;
  private bufferedSamples: Float32Array;
  /** The time of the next output sample, in samples of `bufferedSamples`. */
  private position: number;

  constructor(inputRate: number, outputRate: number) {
    this.step = inputRate / outputRate;
    this.cutoff = PASSBAND_SHARE * Math.min(1, outputRate / inputRate);
    this.halfWidth = Math.ceil(ZERO_CROSSING_COUNT / this.cutoff);
    this.bufferedSamples = new Float32Array(this.halfWidth);
    this.position = this.halfWidth;
  }

  /** Adds samples of the stream, and returns the output samples that this completes. */
  add(samples: Float32Array): Float32Array {
    const buffer = new Float32Array(this.bufferedSamples.length + samples.length);
    buffer.set(this.bufferedSamples);
    buffer.set(samples, this.bufferedSamples.length);
    const count = Math.max(0, Math.ceil((buffer.length - this.halfWidth - this.position) / this.step));
    const output = new Float32Array(count);
    for (let i = 0; i < count; i++) output[i] = this.sampleAt(buffer, this.position + i * this.step);
    const nextPosition = this.position + count * this.step;
    const droppedCount = Math.min(buffer.length, Math.max(0, Math.floor(nextPosition) - this.halfWidth));
    this.bufferedSamples = buffer.slice(droppedCount);
    this.position = nextPosition - droppedCount;
    return output;
  }

  private sampleAt(samples: Float32Array, position: number): number {
    const firstIndex = Math.max(0, Math.ceil(position - this.halfWidth));
    const lastIndex = Math.min(samples.length - 1, Math.floor(position + this.halfWidth));
    let sum = 0;
    for (let i = firstIndex; i <= lastIndex; i++) sum += (samples[i] ?? 0) * this.weightAt(i - position);
    return sum;
  }

  private weightAt(distance: number): number {
    const x = Math.PI * this.cutoff * distance;
    const window = 0.5 + 0.5 * Math.cos((Math.PI * distance) / (this.halfWidth + 1));
    return window * (Math.abs(x) < 1e-9 ? this.cutoff : (this.cutoff * Math.sin(x)) / x);
  }
}

/** Converts samples from -1 to 1 to 16-bit PCM. */
export function toPcm(samples: Float32Array): Int16Array {
  return Int16Array.from(samples, (value) => Math.round(Math.max(-1, Math.min(1, value)) * 32767));
}
