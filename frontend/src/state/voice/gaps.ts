/** Samples of exact silence that count as a hole: browsers insert this many at a time if sound is late. */
const HOLE_SAMPLES = 128;
/** Seconds of exact silence that count as silence rather than a hole, even if they begin abruptly. */
const SILENCE_S = 1;
/**
 * The samples before a hole that show whether sound was cut off there, and the level above which they are sound: -40
 * dB.
 */
const EDGE_SAMPLES = 32;
const LOUD_LEVEL = 0.01;
/** Seconds in which the least delayed sound is searched for, and the increase of its delay that counts as a gap. */
const WINDOW_S = 0.25;
const LATE_MS = 60;
/** The number of windows at the start of a stream, whose timing is irregular. */
const SETTLING = 2;

/**
 * Finds gaps in an audio stream. A busy machine inserts holes of exact silence, at which sound ends abruptly, or drops
 * samples, so that all later samples arrive late.
 */
export class GapFinder {
  private lostSamples = 0;
  private zeros = 0;
  private edge = new Float32Array(EDGE_SAMPLES);
  private edgeAt = 0;
  private sampleCount = 0;
  private windowEnd: number;
  private windows = 0;
  private minimumDelay = Infinity;
  private previousDelay = Infinity;

  /** Starts at the beginning of a stream with this sample rate, Hz. */
  constructor(private readonly rate: number) {
    this.windowEnd = WINDOW_S * rate;
  }

  /** Adds the next samples of the stream, -1 to 1, which arrived at a time in ms. */
  add(samples: Float32Array, now: number): void {
    for (const sample of samples) this.lookForHole(sample);
    this.sampleCount += samples.length;
    this.minimumDelay = Math.min(this.minimumDelay, now - (1000 * this.sampleCount) / this.rate);
    if (this.sampleCount < this.windowEnd) return;
    const extraDelay = this.minimumDelay - this.previousDelay;
    if (this.windows >= SETTLING && extraDelay > LATE_MS) this.lostSamples += extraDelay / 1000;
    this.windows += 1;
    this.windowEnd += WINDOW_S * this.rate;
    this.previousDelay = this.minimumDelay;
    this.minimumDelay = Infinity;
  }

  /** Returns the seconds lost since the last call. */
  takeLost(): number {
    const { lostSamples } = this;
    this.lostSamples = 0;
    return lostSamples;
  }

  private lookForHole(sample: number): void {
    if (sample === 0) {
      this.zeros += 1;
      return;
    }
    if (this.zeros >= HOLE_SAMPLES) {
      const isCutOff = this.edge.some((sample) => Math.abs(sample) > LOUD_LEVEL);
      if (isCutOff && this.zeros < SILENCE_S * this.rate) this.lostSamples += this.zeros / this.rate;
      this.edge.fill(0);
    }
    this.zeros = 0;
    this.edge[this.edgeAt] = sample;
    this.edgeAt = (this.edgeAt + 1) % EDGE_SAMPLES;
  }
}
