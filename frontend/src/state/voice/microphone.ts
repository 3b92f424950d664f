import { Signal } from "../../signal";
import type { CaptureMessage } from "./capture-worklet";
import workletUrl from "./capture-worklet.ts?worker&url";

/**
 * Why there is no sound. `insecure`: browsers permit microphones only over HTTPS and on this machine; `denied`: the
 * user or a policy forbids it; `none`: there is no microphone; `busy`: another program uses it; `lost`: it was removed.
 */
export type MicrophoneProblem = "insecure" | "denied" | "none" | "busy" | "lost" | "failed";

/** A running capture of a microphone; tests substitute their own. */
export interface Capture {
  /** Requests the current part of a block; resolves once it is delivered. */
  flush(): Promise<void>;
  close(): void;
}

/** Resolves once the capture has started; `onBlock` receives sound, and the seconds missing from it. */
export type OpenCapture = (onBlock: (samples: Int16Array, lostSeconds: number) => void, onLost: () => void) => Promise<Capture>;

/** The browser's microphone, which is opened on the first request and closed when it is no longer needed. */
export class Microphone {
  /** Emits blocks of a tenth of a second, mono, 16 kHz. */
  readonly block = new Signal<Int16Array>();
  readonly changed = new Signal();
  problem: MicrophoneProblem | null = null;
  /** The browser's message for a problem of unknown kind. */
  detail = "";
  /** The peak of the last block, 0 to 1. */
  peak = 0;
  /** The seconds of sound lost so far, because a busy machine does not record everything. */
  lostSeconds = 0;
  private capture: Capture | null = null;
  private opening: Promise<boolean> | null = null;
  /** The number of attempts to open the microphone; results of an abandoned attempt are dropped. */
  private attempt = 0;

  constructor(private readonly openCapture: OpenCapture = openBrowserCapture) {}

  get isOpen(): boolean {
    return this.capture !== null;
  }

  /** Whether the user is being asked for permission, or the microphone is starting. */
  get isOpening(): boolean {
    return this.opening !== null;
  }

  /** Opens the microphone if it is closed; returns false if there is a `problem`. */
  open(): Promise<boolean> {
    if (this.capture) return Promise.resolve(true);
    this.problem = null;
    this.opening ??= this.start();
    this.changed.emit();
    return this.opening;
  }

  /** Delivers the sound recorded so far as a block, however short. */
  async flush(): Promise<void> {
    await this.capture?.flush();
  }

  close(): void {
    this.attempt += 1;
    this.capture?.close();
    this.capture = null;
    this.peak = 0;
    this.changed.emit();
  }

  private async start(): Promise<boolean> {
    const attempt = ++this.attempt;
    try {
      const capture = await this.openCapture(
        (samples, lostSeconds) => {
          if (attempt === this.attempt) this.addBlock(samples, lostSeconds);
        },
        () => {
          if (attempt === this.attempt) this.fail("lost");
        },
      );
      if (attempt !== this.attempt) {
        capture.close();
        return false;
      }
      this.capture = capture;
      return true;
    } catch (error) {
      if (attempt === this.attempt) this.fail(problemOf(error), error instanceof Error ? error.message : String(error));
      return false;
    } finally {
      this.opening = null;
      this.changed.emit();
    }
  }

  private addBlock(samples: Int16Array, lostSeconds: number): void {
    this.lostSeconds += lostSeconds;
    if (samples.length === 0) return;
    this.peak = samples.reduce((maximum, sample) => Math.max(maximum, Math.abs(sample)), 0) / 32768;
    this.block.emit(samples);
  }

  private fail(problem: MicrophoneProblem, detail = ""): void {
    this.problem = problem;
    this.detail = detail;
    this.close();
  }
}

class InsecureError extends Error {}

const PROBLEM_BY_ERROR_NAME: Readonly<Record<string, MicrophoneProblem>> = {
  NotAllowedError: "denied",
  SecurityError: "denied",
  NotFoundError: "none",
  OverconstrainedError: "none",
  NotReadableError: "busy",
  AbortError: "busy",
};

function problemOf(error: unknown): MicrophoneProblem {
  if (error instanceof InsecureError) return "insecure";
  return (error instanceof Error ? PROBLEM_BY_ERROR_NAME[error.name] : undefined) ?? "failed";
}

/** Opens the microphone that the user allows, through an AudioWorklet. */
async function openBrowserCapture(onBlock: (samples: Int16Array, lostSeconds: number) => void, onLost: () => void): Promise<Capture> {
  // On an insecure address, browsers do not define this property.
  const devices = (navigator as Partial<Navigator>).mediaDevices;
  if (!isSecureContext || !devices) throw new InsecureError("no secure context");
  const context = new AudioContext();
  let tracks: MediaStreamTrack[] = [];
  const close = (): void => {
    for (const track of tracks) track.stop();
    void context.close();
  };
  try {
    // Load the module first: sound between opening the microphone and loading would be lost.
    await context.audioWorklet.addModule(workletUrl);
    const resumption = context.resume();
    resumption.catch(() => undefined); // the promise is awaited below, unless there is no microphone
    const stream = await devices.getUserMedia({
      audio: { channelCount: 1, echoCancellation: true, noiseSuppression: true, autoGainControl: true },
    });
    tracks = stream.getTracks();
    const node = new AudioWorkletNode(context, "linkwright-capture", { numberOfOutputs: 0 });
    const resolvers = new Map<number, () => void>();
    let requestCount = 0;
    const firstBlock = new Promise<void>((resolve) => {
      node.port.onmessage = ({ data: { samples, lostSeconds, answeredRequest } }: MessageEvent<CaptureMessage>) => {
        resolve();
        onBlock(samples, lostSeconds);
        if (answeredRequest === null) return;
        resolvers.get(answeredRequest)?.();
        resolvers.delete(answeredRequest);
      };
    });
    context.createMediaStreamSource(stream).connect(node);
    for (const track of tracks) track.addEventListener("ended", onLost);
    await resumption;
    await firstBlock;
    const flush = (): Promise<void> =>
      new Promise((resolve) => {
        resolvers.set((requestCount += 1), resolve);
        node.port.postMessage(requestCount);
      });
    return { flush, close };
  } catch (error) {
    close();
    throw error;
  }
}
