import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { Speaker } from "../src/state/voice/speaker";
import type { TextStorage } from "../src/storage";

/** Voices of a browser, which record what they should say. */
class Voices extends EventTarget {
  readonly spoken: [text: string, lang: string, voice: string][] = [];
  cancelCount = 0;
  speaking = false;
  private availableVoices: SpeechSynthesisVoice[] = [];

  getVoices(): SpeechSynthesisVoice[] {
    return this.availableVoices;
  }

  speak({ text, lang, voice }: SpeechSynthesisUtterance): void {
    this.spoken.push([text, lang, voice?.name ?? ""]);
  }

  cancel(): void {
    this.cancelCount += 1;
  }

  /** Voices arrive some time after the page has loaded. */
  arrive(...voices: [name: string, lang: string][]): void {
    this.availableVoices = voices.map(([name, lang]) => ({ name, lang, voiceURI: name, default: false, localService: true }));
    this.dispatchEvent(new Event("voiceschanged"));
  }
}

let voices: Voices;
let storedTexts: Map<string, string>;
let storage: TextStorage;

beforeEach(() => {
  voices = new Voices();
  storedTexts = new Map();
  storage = { getItem: (key) => storedTexts.get(key) ?? null, setItem: (key, value) => void storedTexts.set(key, value) };
  vi.stubGlobal("speechSynthesis", voices);
  vi.stubGlobal(
    "SpeechSynthesisUtterance",
    class {
      lang = "";
      voice: SpeechSynthesisVoice | null = null;
      constructor(readonly text: string) {}
    },
  );
  vi.stubGlobal("navigator", { languages: ["en-GB", "de"] });
});

afterEach(() => {
  vi.unstubAllGlobals();
});

it("is silent until it is switched on, and stops when it is switched off", () => {
  const speaker = new Speaker(storage);
  speaker.speak("on my way");
  expect(voices.spoken).toEqual([]);
  speaker.configure({ on: true });
  speaker.speak("on my way");
  speaker.speak("");
  expect(voices.spoken).toEqual([["on my way", "", ""]]);
  speaker.configure({ on: false });
  expect(voices.cancelCount).toBe(1);
});

it("leaves the voice to the browser, but marks Chinese texts as Chinese", () => {
  const speaker = new Speaker(storage);
  speaker.configure({ on: true });
  speaker.speak("我这就去");
  expect(voices.spoken).toEqual([["我这就去", "zh-CN", ""]]);
});

it("lists the user's languages first, reports when voices arrive, and uses the chosen one, also next time", () => {
  const speaker = new Speaker(storage);
  let changeCount = 0;
  speaker.changed.on(() => (changeCount += 1));
  voices.arrive(["Ting", "zh-CN"], ["Hans", "de-DE"], ["Anna", "en-US"]);
  expect(changeCount).toBe(1);
  expect(speaker.voices.map(({ name }) => name)).toEqual(["Anna", "Hans", "Ting"]);
  speaker.configure({ on: true, voice: "Hans" });
  new Speaker(storage).speak("ich komme");
  expect(voices.spoken).toEqual([["ich komme", "de-DE", "Hans"]]);
});

it("ignores a missing voice and invalid settings", () => {
  storedTexts.set("linkwright.speaker.1", "{");
  const speaker = new Speaker(storage);
  expect(speaker.settings).toEqual({ on: false, voice: "" });
  speaker.configure({ on: true, voice: "nobody" });
  speaker.speak("here");
  expect(voices.spoken).toEqual([["here", "", ""]]);
});

it("is silent if the browser cannot speak", () => {
  vi.stubGlobal("speechSynthesis", undefined);
  const speaker = new Speaker(storage);
  speaker.configure({ on: true });
  speaker.speak("nobody hears it");
  expect([speaker.voices, speaker.isSpeaking]).toEqual([[], false]);
});
