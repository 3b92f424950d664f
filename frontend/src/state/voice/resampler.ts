/** The number of zero crossings of the sinc on each side. */
const REACH = 16;
/** The share of the band that is preserved; the filter needs the rest to roll off. */
const BAND = 0.92;

/**
 * Converts a stream of samples to another sample rate: each output sample is a sum of the input samples around its
 * time, weighted by a windowed sinc, which also removes frequencies above the new limit.
 */
export class Resampler {
  private readonly step: number;
  private readonly half: number;
  private readonly cutoff: number;
  private buffered: Float32Array;
  /** The time of the next output sample, in samples of `buffered`. */
  private at: number;

  constructor(from: number, to: number) {
    this.step = from / to;
    this.cutoff = BAND * Math.min(1, to / from);
    this.half = Math.ceil(REACH / this.cutoff);
    this.buffered = new Float32Array(this.half);
    this.at = this.half;
  }

  /** Adds samples of the stream, and returns the output samples that this completes. */
  add(samples: Float32Array): Float32Array {
    const all = new Float32Array(this.buffered.length + samples.length);
    all.set(this.buffered);
    all.set(samples, this.buffered.length);
    const count = Math.max(0, Math.ceil((all.length - this.half - this.at) / this.step));
    const output = new Float32Array(count);
    for (let i = 0; i < count; i++) output[i] = this.sampleAt(all, this.at + i * this.step);
    const next = this.at + count * this.step;
    const drop = Math.min(all.length, Math.max(0, Math.floor(next) - this.half));
    this.buffered = all.slice(drop);
    this.at = next - drop;
    return output;
  }

  private sampleAt(all: Float32Array, at: number): number {
    const first = Math.max(0, Math.ceil(at - this.half));
    const last = Math.min(all.length - 1, Math.floor(at + this.half));
    let sum = 0;
    for (let i = first; i <= last; i++) sum += (all[i] ?? 0) * this.weight(i - at);
    return sum;
  }

  private weight(distance: number): number {
    const x = Math.PI * this.cutoff * distance;
    const window = 0.5 + 0.5 * Math.cos((Math.PI * distance) / (this.half + 1));
    return window * (Math.abs(x) < 1e-9 ? this.cutoff : (this.cutoff * Math.sin(x)) / x);
  }
}

/** Converts samples from -1 to 1 to 16-bit PCM. */
export function toPcm(samples: Float32Array): Int16Array {
  return Int16Array.from(samples, (value) => Math.round(Math.max(-1, Math.min(1, value)) * 32767));
}
