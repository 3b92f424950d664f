/// <reference lib="webworker" />
import { MOST_SAMPLES, SOUND_RATE } from "../../protocol";
import { pcm, Resampler } from "./resampler";

declare const sampleRate: number;
declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}
declare function registerProcessor(name: string, processor: new () => AudioWorkletProcessor): void;

/**
 * Runs in the browser's thread for sound: what the microphone gives becomes blocks of a tenth of a second, mono, at the
 * rate that engines of speech want. Any message has what is there of a block sent at once.
 */
class Capture extends AudioWorkletProcessor {
  private readonly resampler = new Resampler(sampleRate, SOUND_RATE);
  private readonly block = new Int16Array(MOST_SAMPLES);
  private filled = 0;

  constructor() {
    super();
    this.port.onmessage = () => this.send();
  }

  process([channels = []]: readonly Float32Array[][]): boolean {
    const [first] = channels;
    if (!first) return true;
    const mono = first.map((_, i) => channels.reduce((sum, channel) => sum + (channel[i] ?? 0), 0) / channels.length);
    for (const sample of pcm(this.resampler.take(mono))) {
      this.block[this.filled++] = sample;
      if (this.filled === MOST_SAMPLES) this.send();
    }
    return true;
  }

  /** The last message of a request is empty if nothing is left: it says that all has been sent. */
  private send(): void {
    this.port.postMessage(this.block.slice(0, this.filled));
    this.filled = 0;
  }
}

registerProcessor("linkwright-capture", Capture);
