import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { describeObstacle } from "../src/panels/voice/voice-words";
import type { PageMessage } from "../src/protocol";
import { GapFinder } from "../src/state/voice/gaps";
import { computeMeterShare } from "../src/state/voice/level";
import { Microphone, type OpenCapture } from "../src/state/voice/microphone";
import { toPcm, Resampler } from "../src/state/voice/resampler";
import { encodeSound, VoiceState } from "../src/state/voice/voice";
import { WordsState } from "../src/state/voice/words";

vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

describe("resampling", () => {
  const createTone = (hertz: number, rate: number, count: number): Float32Array =>
    Float32Array.from({ length: count }, (_, i) => Math.sin((2 * Math.PI * hertz * i) / rate));

  const resample = (samples: Float32Array, rate: number): Float32Array => {
    const resampler = new Resampler(rate, 16_000);
    const parts: number[] = [];
    for (let offset = 0; offset < samples.length; offset += 128) parts.push(...resampler.add(samples.subarray(offset, offset + 128)));
    return Float32Array.from(parts);
  };

  it.each([48_000, 44_100, 16_000, 8_000])("a tone at %i Hz stays one, in its place", (rate) => {
    const resampled = resample(createTone(1000, rate, rate), rate);
    expect(Math.abs(resampled.length - 16_000)).toBeLessThan(100);
    const expectedTone = createTone(1000, 16_000, resampled.length);
    const largestError = resampled.slice(100, -100).reduce((largest, value, i) => Math.max(largest, Math.abs(value - (expectedTone[i + 100] ?? 0))), 0);
    expect(largestError).toBeLessThan(0.02);
  });

  it("removes frequencies that the new rate cannot represent", () => {
    const resampled = resample(createTone(10_000, 48_000, 48_000), 48_000).slice(100, -100);
    expect(resampled.reduce((largest, value) => Math.max(largest, Math.abs(value)), 0)).toBeLessThan(0.01);
  });

  it("samples have 16 bits, and louder ones are clipped", () => {
    expect([...toPcm(Float32Array.from([0, 1, -1, 2, 0.5]))]).toEqual([0, 32767, -32767, 32767, 16384]);
  });
});

it("a level meter is logarithmic", () => {
  expect(computeMeterShare(1)).toBe(1);
  expect(computeMeterShare(0.001)).toBeCloseTo(0);
  expect(computeMeterShare(0)).toBe(0);
  expect(computeMeterShare(Math.sqrt(0.001))).toBeCloseTo(0.5);
});

describe("gaps", () => {
  const QUANTUM = 128;
  const loudQuantum = new Float32Array(QUANTUM).map((_, i) => 0.3 * Math.sin(i));
  const silentQuantum = new Float32Array(QUANTUM);

  /** Returns the milliseconds found to be lost in two seconds of sound at 48 kHz; `change` returns the samples that replace a quantum, and its delay. */
  const measureLost = (replaceQuantum: (number: number) => { samples?: Float32Array; lateMs?: number }): number => {
    const finder = new GapFinder(48_000);
    for (let number = 0; number < 750; number++) {
      const { samples = loudQuantum, lateMs = 0 } = replaceQuantum(number);
      finder.add(samples, 5000 + (number * QUANTUM) / 48 + lateMs);
    }
    return Math.round(1000 * finder.takeLostSeconds());
  };

  it("do not occur in sound on time, in silence, or in late sound that catches up", () => {
    expect(measureLost(() => ({}))).toBe(0);
    expect(measureLost(() => ({ samples: silentQuantum }))).toBe(0);
    const createFading = (gain: number): Float32Array => loudQuantum.map((sample, i) => (sample * gain * (QUANTUM - i)) / QUANTUM);
    expect(measureLost((number) => (number % 50 < 10 ? { samples: silentQuantum } : number % 50 === 49 ? { samples: createFading(0.01) } : {}))).toBe(0);
    expect(measureLost((number) => ({ lateMs: number > 300 && number < 340 ? 8 * (340 - number) : 0 }))).toBe(0);
    expect(measureLost((number) => ({ lateMs: -0.002 * number }))).toBe(0);
  });

  it("occur where sound is exactly zero for a short time", () => {
    expect(measureLost((number) => (number === 400 ? { samples: silentQuantum } : {}))).toBe(3);
    expect(measureLost((number) => (number >= 300 && number < 330 ? { samples: silentQuantum } : {}))).toBe(80);
    expect(measureLost((number) => (number >= 100 && number < 700 ? { samples: silentQuantum } : {}))).toBe(0);
  });

  it("occur where sound stays late from one time on", () => {
    expect(measureLost((number) => ({ lateMs: number > 400 ? 100 : 0 }))).toBe(100);
  });

  it("are reported once", () => {
    const finder = new GapFinder(48_000);
    for (const samples of [loudQuantum, silentQuantum, loudQuantum]) finder.add(samples, 0);
    expect(finder.takeLostSeconds()).toBeGreaterThan(0);
    expect(finder.takeLostSeconds()).toBe(0);
  });
});

describe("talking", () => {
  let sentMessages: PageMessage[];
  let frames: ArrayBuffer[];
  let connection: Connection;
  let deliver: (samples: Int16Array, lostSeconds?: number) => void;
  let loseMicrophone: () => void;
  let closeCount = 0;
  const storage = { getItem: () => null, setItem: () => undefined };

  const openFake: OpenCapture = (onBlock, onLost) => {
    deliver = (samples, lostSeconds = 0) => onBlock(samples, lostSeconds);
    loseMicrophone = onLost;
    return Promise.resolve({
      flush: () => {
        onBlock(Int16Array.of(7), 0);
        return Promise.resolve();
      },
      close: () => void (closeCount += 1),
    });
  };
  const listModes = (): string[] => sentMessages.flatMap((message) => (message.type === "talk" ? [message.mode] : []));
  const flushPromises = async (): Promise<void> => {
    for (let i = 0; i < 10; i++) await Promise.resolve();
  };

  beforeEach(() => {
    [sentMessages, frames, closeCount] = [[], [], 0];
    vi.useFakeTimers();
    vi.stubGlobal("window", { setTimeout });
    connection = new Connection("ws://localhost/ws");
    vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
    vi.spyOn(connection, "sendBytes").mockImplementation((frame) => void frames.push(frame));
  });

  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it("sends blocks while the button is held, and the last part of one", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await flushPromises();
    deliver(Int16Array.of(1, -2));
    voice.release();
    await flushPromises();
    deliver(Int16Array.of(3));
    expect(listModes()).toEqual(["held", "ready"]);
    expect(frames).toEqual([encodeSound(Int16Array.of(1, -2)), encodeSound(Int16Array.of(7))]);
    expect([...new Int16Array(frames[0]!, 16)]).toEqual([1, -2]);
    expect([...new Uint32Array(frames[0]!, 0, 4)]).toEqual([5, 2, 0, 0]);
  });

  it("reports sound that the browser lost with the next block only", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await flushPromises();
    deliver(Int16Array.of(1), 0.1);
    deliver(Int16Array.of(2));
    deliver(new Int16Array(0), 0.2);
    deliver(Int16Array.of(3));
    voice.release();
    await flushPromises();
    deliver(Int16Array.of(4), 0.3);
    voice.press();
    await flushPromises();
    deliver(Int16Array.of(5));
    deliver(Int16Array.of(6), 3600); // the computer was asleep
    expect(frames.map((frame) => new Uint32Array(frame, 0, 4)[2])).toEqual([1600, 0, 3200, 0, 0, 80_000]);
  });

  it("releases the microphone a while after use, and at once when the page is closed", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await flushPromises();
    voice.release();
    await flushPromises();
    expect(closeCount).toBe(0);
    vi.advanceTimersByTime(60_000);
    expect(closeCount).toBe(1);
    voice.press();
    await flushPromises();
    voice.releaseMicrophone();
    await flushPromises();
    expect(closeCount).toBe(2);
    expect(listModes().at(-1)).toBe("off");
  });

  it("shows gaps in a command until the next command", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await flushPromises();
    expect(voice.hasGaps).toBe(false);
    deliver(Int16Array.of(1), 0.02);
    expect(voice.hasGaps).toBe(false);
    deliver(Int16Array.of(1), 0.02);
    expect(voice.hasGaps).toBe(true);
    voice.release();
    await flushPromises();
    expect(voice.hasGaps).toBe(true);
    expect(describeObstacle(voice)).toContain("gaps");
    connection.message.emit({ type: "conversation_text", number: 1, part: "response", text: "forward" });
    expect(describeObstacle(voice)).toBe(null); // the command was understood after all, or the robot asks for it again
    voice.press();
    expect(voice.hasGaps).toBe(false);
    deliver(Int16Array.of(1), 0.04);
    expect(describeObstacle(voice)).toContain("gaps");
  });

  it("sends nothing if the button is released before the microphone is ready", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    voice.release();
    await flushPromises();
    expect(listModes()).toEqual(["ready"]);
  });

  it.each([
    ["NotAllowedError", "denied"],
    ["NotFoundError", "none"],
    ["NotReadableError", "busy"],
    ["Other", "failed"],
  ])("%s of the browser is reported as %s", async (name, problem) => {
    const openRefused: OpenCapture = () => Promise.reject(Object.assign(new Error("why"), { name }));
    const voice = new VoiceState(connection, storage, new Microphone(openRefused));
    voice.press();
    await flushPromises();
    expect(voice.microphone.problem).toBe(problem);
    expect([voice.isHeld, listModes()]).toEqual([false, []]);
  });

  it("ends when the microphone is removed, and requests it again", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.setAlwaysListening(true);
    await flushPromises();
    expect(listModes()).toEqual(["open"]);
    loseMicrophone();
    expect([voice.isAlwaysListening, voice.microphone.problem, listModes().at(-1)]).toEqual([false, "lost", "off"]);
    voice.press();
    await flushPromises();
    expect([voice.microphone.problem, listModes().at(-1)]).toEqual([null, "held"]);
  });

  it("releases the button when the connection is lost", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await flushPromises();
    connection.stateChanged.emit("reconnecting");
    await flushPromises();
    expect(voice.isHeld).toBe(false);
  });

  it("keeps the conversation, and replaces the partial text by the final one", () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    const receiveText = (part: "partial" | "text" | "response", text: string): void =>
      connection.message.emit({ type: "conversation_text", number: 1, part, text });
    receiveText("partial", "turn");
    expect([voice.partial, voice.history.length]).toEqual(["turn", 0]);
    receiveText("text", "turn left");
    receiveText("response", "Turning left.");
    expect(voice.partial).toBe("");
    expect(voice.history).toEqual([
      { part: "text", text: "turn left" },
      { part: "response", text: "Turning left." },
    ]);
  });

  it("subscribes to the state once, however many panels show it", () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    const [firstPanel, secondPanel] = [{}, {}];
    voice.watch(firstPanel, true);
    voice.watch(secondPanel, true);
    voice.watch(firstPanel, false);
    voice.watch(secondPanel, false);
    expect(sentMessages).toEqual([
      { type: "watch_voice", watched: true },
      { type: "watch_voice", watched: false },
    ]);
  });

  it("counts only good recordings of words that are enrolled here, made since then", () => {
    const wordsState = new WordsState(connection, new VoiceState(connection, storage, new Microphone(openFake)));
    const words = [{ name: "stop", takes: 3 }, { name: "forward", takes: 3 }];
    connection.message.emit({ type: "voice_words", words, enough: 3, file: "words.json", problem: null });
    const judgeTake = (name: string, code: string | null): void =>
      connection.message.emit({ type: "take_judged", number: 1, name, code, text: "", peak: 0.5, seconds: 0.5 });
    judgeTake("stop", null);
    wordsState.setEnrollingHere(true);
    for (const code of [null, "VOICE205", null]) judgeTake("stop", code);
    expect(wordsState.missingHere.map(({ name }) => name)).toEqual(["stop", "forward"]);
    judgeTake("stop", null);
    expect(wordsState.missingHere.map(({ name }) => name)).toEqual(["forward"]);
  });
});
