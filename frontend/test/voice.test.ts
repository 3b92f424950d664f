import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import { describeObstacle } from "../src/panels/voice/voice-words";
import type { PageMessage } from "../src/protocol";
import { GapFinder } from "../src/state/voice/gaps";
import { meterShare } from "../src/state/voice/level";
import { Microphone, type OpenCapture } from "../src/state/voice/microphone";
import { toPcm, Resampler } from "../src/state/voice/resampler";
import { encodeSound, VoiceState } from "../src/state/voice/voice";
import { WordsState } from "../src/state/voice/words";

vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

describe("resampling", () => {
  const tone = (hertz: number, rate: number, count: number): Float32Array =>
    Float32Array.from({ length: count }, (_, i) => Math.sin((2 * Math.PI * hertz * i) / rate));

  const through = (samples: Float32Array, rate: number): Float32Array => {
    const resampler = new Resampler(rate, 16_000);
    const parts: number[] = [];
    for (let at = 0; at < samples.length; at += 128) parts.push(...resampler.add(samples.subarray(at, at + 128)));
    return Float32Array.from(parts);
  };

  it.each([48_000, 44_100, 16_000, 8_000])("a tone at %i Hz stays one, in its place", (rate) => {
    const made = through(tone(1000, rate, rate), rate);
    expect(Math.abs(made.length - 16_000)).toBeLessThan(100);
    const wanted = tone(1000, 16_000, made.length);
    const worst = made.slice(100, -100).reduce((most, value, i) => Math.max(most, Math.abs(value - (wanted[i + 100] ?? 0))), 0);
    expect(worst).toBeLessThan(0.02);
  });

  it("removes frequencies that the new rate cannot represent", () => {
    const made = through(tone(10_000, 48_000, 48_000), 48_000).slice(100, -100);
    expect(made.reduce((most, value) => Math.max(most, Math.abs(value)), 0)).toBeLessThan(0.01);
  });

  it("samples have 16 bits, and louder ones are clipped", () => {
    expect([...toPcm(Float32Array.from([0, 1, -1, 2, 0.5]))]).toEqual([0, 32767, -32767, 32767, 16384]);
  });
});

it("a level meter is logarithmic", () => {
  expect(meterShare(1)).toBe(1);
  expect(meterShare(0.001)).toBeCloseTo(0);
  expect(meterShare(0)).toBe(0);
  expect(meterShare(Math.sqrt(0.001))).toBeCloseTo(0.5);
});

describe("gaps", () => {
  const QUANTUM = 128;
  const loud = new Float32Array(QUANTUM).map((_, i) => 0.3 * Math.sin(i));
  const silent = new Float32Array(QUANTUM);

  /** Returns the milliseconds found to be lost in two seconds of sound at 48 kHz; `change` returns the samples that replace a quantum, and its delay. */
  const found = (change: (number: number) => { samples?: Float32Array; lateMs?: number }): number => {
    const finder = new GapFinder(48_000);
    for (let number = 0; number < 750; number++) {
      const { samples = loud, lateMs = 0 } = change(number);
      finder.add(samples, 5000 + (number * QUANTUM) / 48 + lateMs);
    }
    return Math.round(1000 * finder.takeLost());
  };

  it("do not occur in sound on time, in silence, or in late sound that catches up", () => {
    expect(found(() => ({}))).toBe(0);
    expect(found(() => ({ samples: silent }))).toBe(0);
    const fading = (gain: number): Float32Array => loud.map((sample, i) => (sample * gain * (QUANTUM - i)) / QUANTUM);
    expect(found((number) => (number % 50 < 10 ? { samples: silent } : number % 50 === 49 ? { samples: fading(0.01) } : {}))).toBe(0);
    expect(found((number) => ({ lateMs: number > 300 && number < 340 ? 8 * (340 - number) : 0 }))).toBe(0);
    expect(found((number) => ({ lateMs: -0.002 * number }))).toBe(0);
  });

  it("occur where sound is exactly zero for a short time", () => {
    expect(found((number) => (number === 400 ? { samples: silent } : {}))).toBe(3);
    expect(found((number) => (number >= 300 && number < 330 ? { samples: silent } : {}))).toBe(80);
    expect(found((number) => (number >= 100 && number < 700 ? { samples: silent } : {}))).toBe(0);
  });

  it("occur where sound stays late from one time on", () => {
    expect(found((number) => ({ lateMs: number > 400 ? 100 : 0 }))).toBe(100);
  });

  it("are reported once", () => {
    const finder = new GapFinder(48_000);
    for (const samples of [loud, silent, loud]) finder.add(samples, 0);
    expect(finder.takeLost()).toBeGreaterThan(0);
    expect(finder.takeLost()).toBe(0);
  });
});

describe("talking", () => {
  let sent: PageMessage[];
  let frames: ArrayBuffer[];
  let connection: Connection;
  let deliver: (samples: Int16Array, lostSeconds?: number) => void;
  let lose: () => void;
  let closed = 0;
  const storage = { getItem: () => null, setItem: () => undefined };

  const openFake: OpenCapture = (block, lost) => {
    deliver = (samples, lostSeconds = 0) => block(samples, lostSeconds);
    lose = lost;
    return Promise.resolve({
      flush: () => {
        block(Int16Array.of(7), 0);
        return Promise.resolve();
      },
      close: () => void (closed += 1),
    });
  };
  const modes = (): string[] => sent.flatMap((message) => (message.type === "talk" ? [message.mode] : []));
  const soon = async (): Promise<void> => {
    for (let i = 0; i < 10; i++) await Promise.resolve();
  };

  beforeEach(() => {
    [sent, frames, closed] = [[], [], 0];
    vi.useFakeTimers();
    vi.stubGlobal("window", { setTimeout });
    connection = new Connection("ws://localhost/ws");
    vi.spyOn(connection, "send").mockImplementation((message) => void sent.push(message));
    vi.spyOn(connection, "sendBytes").mockImplementation((frame) => void frames.push(frame));
  });

  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it("sends blocks while the button is held, and the last part of one", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await soon();
    deliver(Int16Array.of(1, -2));
    voice.release();
    await soon();
    deliver(Int16Array.of(3));
    expect(modes()).toEqual(["held", "ready"]);
    expect(frames).toEqual([encodeSound(Int16Array.of(1, -2)), encodeSound(Int16Array.of(7))]);
    expect([...new Int16Array(frames[0]!, 16)]).toEqual([1, -2]);
    expect([...new Uint32Array(frames[0]!, 0, 4)]).toEqual([5, 2, 0, 0]);
  });

  it("reports sound that the browser lost with the next block only", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await soon();
    deliver(Int16Array.of(1), 0.1);
    deliver(Int16Array.of(2));
    deliver(new Int16Array(0), 0.2);
    deliver(Int16Array.of(3));
    voice.release();
    await soon();
    deliver(Int16Array.of(4), 0.3);
    voice.press();
    await soon();
    deliver(Int16Array.of(5));
    deliver(Int16Array.of(6), 3600); // the computer was asleep
    expect(frames.map((frame) => new Uint32Array(frame, 0, 4)[2])).toEqual([1600, 0, 3200, 0, 0, 80_000]);
  });

  it("releases the microphone a while after use, and at once when the page is closed", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await soon();
    voice.release();
    await soon();
    expect(closed).toBe(0);
    vi.advanceTimersByTime(60_000);
    expect(closed).toBe(1);
    voice.press();
    await soon();
    voice.releaseMicrophone();
    await soon();
    expect(closed).toBe(2);
    expect(modes().at(-1)).toBe("off");
  });

  it("shows gaps in a command until the next command", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await soon();
    expect(voice.hasGaps).toBe(false);
    deliver(Int16Array.of(1), 0.02);
    expect(voice.hasGaps).toBe(false);
    deliver(Int16Array.of(1), 0.02);
    expect(voice.hasGaps).toBe(true);
    voice.release();
    await soon();
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
    await soon();
    expect(modes()).toEqual(["ready"]);
  });

  it.each([
    ["NotAllowedError", "denied"],
    ["NotFoundError", "none"],
    ["NotReadableError", "busy"],
    ["Other", "failed"],
  ])("%s of the browser is told as %s", async (name, problem) => {
    const fails: OpenCapture = () => Promise.reject(Object.assign(new Error("why"), { name }));
    const voice = new VoiceState(connection, storage, new Microphone(fails));
    voice.press();
    await soon();
    expect(voice.microphone.problem).toBe(problem);
    expect([voice.isHeld, modes()]).toEqual([false, []]);
  });

  it("ends when the microphone is removed, and requests it again", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.setOpen(true);
    await soon();
    expect(modes()).toEqual(["open"]);
    lose();
    expect([voice.isPanelOpen, voice.microphone.problem, modes().at(-1)]).toEqual([false, "lost", "off"]);
    voice.press();
    await soon();
    expect([voice.microphone.problem, modes().at(-1)]).toEqual([null, "held"]);
  });

  it("releases the button when the connection is lost", async () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    voice.press();
    await soon();
    connection.stateChanged.emit("reconnecting");
    await soon();
    expect(voice.isHeld).toBe(false);
  });

  it("keeps the conversation, and replaces the partial text by the final one", () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    const says = (part: "partial" | "text" | "response", text: string): void =>
      connection.message.emit({ type: "conversation_text", number: 1, part, text });
    says("partial", "turn");
    expect([voice.partial, voice.history.length]).toEqual(["turn", 0]);
    says("text", "turn left");
    says("response", "Turning left.");
    expect(voice.partial).toBe("");
    expect(voice.history).toEqual([
      { part: "text", text: "turn left" },
      { part: "response", text: "Turning left." },
    ]);
  });

  it("subscribes to the state once, however many panels show it", () => {
    const voice = new VoiceState(connection, storage, new Microphone(openFake));
    const [one, two] = [{}, {}];
    voice.watch(one, true);
    voice.watch(two, true);
    voice.watch(one, false);
    voice.watch(two, false);
    expect(sent).toEqual([
      { type: "watch_voice", watched: true },
      { type: "watch_voice", watched: false },
    ]);
  });

  it("counts only good recordings of words that are enrolled here, made since then", () => {
    const words = new WordsState(connection, new VoiceState(connection, storage, new Microphone(openFake)));
    const told = [{ name: "stop", takes: 3 }, { name: "forward", takes: 3 }];
    connection.message.emit({ type: "voice_words", words: told, enough: 3, file: "words.json", problem: null });
    const judge = (name: string, code: string | null): void =>
      connection.message.emit({ type: "take_judged", number: 1, name, code, text: "", peak: 0.5, seconds: 0.5 });
    judge("stop", null);
    words.enrollHere(true);
    for (const code of [null, "VOICE205", null]) judge("stop", code);
    expect(words.missingHere.map(({ name }) => name)).toEqual(["stop", "forward"]);
    judge("stop", null);
    expect(words.missingHere.map(({ name }) => name)).toEqual(["forward"]);
  });
});
