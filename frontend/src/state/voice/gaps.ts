/** Samples of exact silence that count as a hole: browsers insert this many at a time if sound is late. */
const HOLE_SAMPLE_COUNT = 128;
/** Seconds of exact silence that count as silence rather than a hole, even if they begin abruptly. */
const SILENCE_S = 1;
/**
 * The samples before a hole that show whether sound was cut off there, and the level above which they are sound: -40
 * dB.
 */
const EDGE_SAMPLE_COUNT = 32;
const LOUD_LEVEL = 0.01;
/** Seconds in which the least delayed sound is searched for, and the increase of its delay that counts as a gap. */
const WINDOW_S = 0.25;
const GAP_DELAY_MS = 60;
/** The number of windows at the start of a stream, whose timing is irregular. */
const SETTLING_WINDOW_COUNT = 2;

/**
 * Finds gaps in an audio stream. A busy machine inserts holes of exact silence, at which sound ends abruptly, or drops
 * samples, so that all later samples arrive late.
 */
export class GapFinder {
  private lostSeconds = 0;
  private zeroCount = 0;
  private edgeSamples = new Float32Array(EDGE_SAMPLE_COUNT);
  private edgeIndex = 0;
  private sampleCount = 0;
  private windowEnd: number;
  private windowCount = 0;
  private minimumDelay = Infinity;
  private previousDelay = Infinity;

  /** Starts at the beginning of a stream with this sample rate, Hz. */
  constructor(private readonly rate: number) {
    this.windowEnd = WINDOW_S * rate;
  }

  /** Adds the next samples of the stream, -1 to 1, which arrived at a time in ms. */
  add(samples: Float32Array, arrivalMs: number): void {
    for (const sample of samples) this.lookForHole(sample);
    this.sampleCount += samples.length;
    this.minimumDelay = Math.min(this.minimumDelay, arrivalMs - (1000 * this.sampleCount) / this.rate);
    if (this.sampleCount < this.windowEnd) return;
    const extraDelay = this.minimumDelay - this.previousDelay;
    if (this.windowCount >= SETTLING_WINDOW_COUNT && extraDelay > GAP_DELAY_MS) this.lostSeconds += extraDelay / 1000;
    this.windowCount += 1;
    this.windowEnd += WINDOW_S * this.rate;
    this.previousDelay = this.minimumDelay;
    this.minimumDelay = Infinity;
  }

  /** Returns the seconds lost since the last call. */
  takeLostSeconds(): number {
    const { lostSeconds } = this;
    this.lostSeconds = 0;
    return lostSeconds;
  }

  private lookForHole(sample: number): void {
    if (sample === 0) {
      this.zeroCount += 1;
      return;
    }
    if (this.zeroCount >= HOLE_SAMPLE_COUNT) {
      const isCutOff = this.edgeSamples.some((sample) => Math.abs(sample) > LOUD_LEVEL);
      if (isCutOff && this.zeroCount < SILENCE_S * this.rate) this.lostSeconds += this.zeroCount / this.rate;
      this.edgeSamples.fill(0);
    }
    this.zeroCount = 0;
    this.edgeSamples[this.edgeIndex] = sample;
    this.edgeIndex = (this.edgeIndex + 1) % EDGE_SAMPLE_COUNT;
  }
}
