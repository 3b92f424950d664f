/// <reference lib="webworker" />
import { MAX_SAMPLES, SOUND_RATE } from "../../protocol";
import { GapFinder } from "./gaps";
import { toPcm, Resampler } from "./resampler";

declare const sampleRate: number;
declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}
declare function registerProcessor(name: string, processor: new () => AudioWorkletProcessor): void;

/** A message from the audio thread. */
export interface CaptureMessage {
  samples: Int16Array;
  /** The seconds of sound lost since the last message. */
  lostSeconds: number;
  /** The number of the request that this answers; all sound until then has been sent. */
  answeredRequest: number | null;
}

/**
 * Converts the microphone's samples in the browser's audio thread into blocks of a tenth of a second, mono, at the
 * sample rate of the speech engines. A message requests the current part of a block immediately, with the message's
 * number.
 */
class Capture extends AudioWorkletProcessor {
  private readonly resampler = new Resampler(sampleRate, SOUND_RATE);
  private readonly gaps = new GapFinder(sampleRate);
  private readonly block = new Int16Array(MAX_SAMPLES);
  private filledCount = 0;
  private hasBegun = false;

  constructor() {
    super();
    this.port.onmessage = ({ data }: MessageEvent<number>) => this.send(data);
  }

  process([channels = []]: readonly Float32Array[][]): boolean {
    if (!this.hasBegun) {
      this.hasBegun = true;
      this.send();
    }
    const [firstChannel] = channels;
    if (!firstChannel) return true;
    const mono = firstChannel.map((_, i) => channels.reduce((sum, channel) => sum + (channel[i] ?? 0), 0) / channels.length);
    this.gaps.add(mono, Date.now());
    for (const sample of toPcm(this.resampler.add(mono))) {
      this.block[this.filledCount++] = sample;
      if (this.filledCount === MAX_SAMPLES) this.send();
    }
    return true;
  }

  /** Sends the current part of a block; `answeredRequest` is the number of the request for it. */
  private send(answeredRequest: number | null = null): void {
    const message: CaptureMessage = { samples: this.block.slice(0, this.filledCount), lostSeconds: this.gaps.takeLostSeconds(), answeredRequest };
    this.port.postMessage(message);
    this.filledCount = 0;
  }
}

registerProcessor("linkwright-capture", Capture);
