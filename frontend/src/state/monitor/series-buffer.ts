/** The kind of time at which samples are plotted. */
export type TimeSource = "received" | "stamp";

const INITIAL_CAPACITY = 1024;
/** The maximum number of samples: ten minutes at 1 kHz. */
const MAX_SAMPLES = 600_000;
/** If stamps go back by more than this, simulated time was reset or a recording started again. */
const RESET_THRESHOLD_S = 1;

/** The samples of a series, the newest last; the oldest are dropped when there are too many. */
export class SeriesBuffer {
  private receiveTimes = new Float64Array(INITIAL_CAPACITY);
  private stamps = new Float64Array(INITIAL_CAPACITY);
  private sampleValues = new Float64Array(INITIAL_CAPACITY);
  private count = 0;

  constructor(private readonly maxSamples = MAX_SAMPLES) {}

  get length(): number {
    return this.count;
  }

  get values(): Float64Array {
    return this.sampleValues.subarray(0, this.count);
  }

  /** Returns the times of the samples, s; the time of receipt replaces the stamp of messages without a header. */
  timesOf(source: TimeSource): Float64Array {
    return (source === "stamp" ? this.stamps : this.receiveTimes).subarray(0, this.count);
  }

  /** Returns the newest time, s; null if there are no samples. */
  latestTimeOf(source: TimeSource): number | null {
    return this.timesOf(source)[this.count - 1] ?? null;
  }

  get lastValue(): number | null {
    return this.sampleValues[this.count - 1] ?? null;
  }

  append(receiveTimes: ArrayLike<number>, stamps: ArrayLike<number>, values: ArrayLike<number>): void {
    this.reserve(values.length);
    for (let index = 0; index < values.length; index++) {
      const time = receiveTimes[index] ?? 0;
      const headerStamp = stamps[index] ?? NaN;
      const stamp = Number.isNaN(headerStamp) ? time : headerStamp;
      // Samples arrive a second time after a jump to another time of a recording, with samples from before it.
      if (this.count > 0 && time < (this.receiveTimes[this.count - 1] ?? 0)) this.count = this.indexFrom("received", time);
      if (this.count > 0 && stamp < (this.stamps[this.count - 1] ?? 0) - RESET_THRESHOLD_S) this.count = 0;
      this.receiveTimes[this.count] = time;
      this.stamps[this.count] = stamp;
      this.sampleValues[this.count] = values[index] ?? NaN;
      this.count++;
    }
  }

  clear(): void {
    this.count = 0;
  }

  /** Returns the index of the first sample at or after a time. */
  indexFrom(source: TimeSource, time: number): number {
    const times = this.timesOf(source);
    let low = 0;
    let high = times.length;
    while (low < high) {
      const center = (low + high) >> 1;
      if ((times[center] ?? 0) < time) low = center + 1;
      else high = center;
    }
    return low;
  }

  private reserve(count: number): void {
    const neededCount = this.count + count;
    if (neededCount <= this.sampleValues.length) return;
    if (neededCount > this.maxSamples) {
      // Drop half of them, so that this happens rarely.
      const remaining = Math.min(this.count, Math.max(0, (this.maxSamples >> 1) - count));
      for (const array of [this.receiveTimes, this.stamps, this.sampleValues]) array.copyWithin(0, this.count - remaining, this.count);
      this.count = remaining;
      if (remaining + count <= this.sampleValues.length) return;
    }
    const capacity = Math.max(this.count + count, Math.min(this.maxSamples, this.sampleValues.length * 2));
    this.receiveTimes = resize(this.receiveTimes, capacity);
    this.stamps = resize(this.stamps, capacity);
    this.sampleValues = resize(this.sampleValues, capacity);
  }
}

function resize(array: Float64Array, capacity: number): Float64Array<ArrayBuffer> {
  const resized = new Float64Array(capacity);
  resized.set(array);
  return resized;
}
