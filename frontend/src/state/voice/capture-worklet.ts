/// <reference lib="webworker" />
import { MOST_SAMPLES, SOUND_RATE } from "../../protocol";
import { GapFinder } from "./gaps";
import { pcm, Resampler } from "./resampler";

declare const sampleRate: number;
declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}
declare function registerProcessor(name: string, processor: new () => AudioWorkletProcessor): void;

/** A message of the thread for sound. */
export interface CaptureMessage {
  samples: Int16Array;
  /** Seconds of sound that were found to be lost since the last message. */
  lost: number;
  /** The number of the request that this answers; all sound until then has been sent. */
  answers: number | null;
}

/**
 * Runs in the browser's thread for sound: the microphone's samples become blocks of a tenth of a second, mono, at the
 * rate that speech engines expect. A message requests the current part of a block at once, with the message's number.
 */
class Capture extends AudioWorkletProcessor {
  private readonly resampler = new Resampler(sampleRate, SOUND_RATE);
  private readonly gaps = new GapFinder(sampleRate);
  private readonly block = new Int16Array(MOST_SAMPLES);
  private filled = 0;
  private began = false;

  constructor() {
    super();
    this.port.onmessage = ({ data }: MessageEvent<number>) => this.send(data);
  }

  process([channels = []]: readonly Float32Array[][]): boolean {
    if (!this.began) {
      this.began = true;
      this.send();
    }
    const [first] = channels;
    if (!first) return true;
    const mono = first.map((_, i) => channels.reduce((sum, channel) => sum + (channel[i] ?? 0), 0) / channels.length);
    this.gaps.take(mono, Date.now());
    for (const sample of pcm(this.resampler.take(mono))) {
      this.block[this.filled++] = sample;
      if (this.filled === MOST_SAMPLES) this.send();
    }
    return true;
  }

  /** Delivers the current part of a block; `answers` is the number of the request for it. */
  private send(answers: number | null = null): void {
    const message: CaptureMessage = { samples: this.block.slice(0, this.filled), lost: this.gaps.takeLost(), answers };
    this.port.postMessage(message);
    this.filled = 0;
  }
}

registerProcessor("linkwright-capture", Capture);
