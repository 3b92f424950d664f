import { LANGUAGES } from "../../protocol/languages";
import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";

export interface SpeakerSettings {
  on: boolean;
  /** The URI of the voice; empty for the browser's choice. */
  voice: string;
}

const STORAGE_KEY = "linkwright.speaker.1";

/** Reads answers aloud with the browser's voices. */
export class Speaker {
  /** The settings or the available voices changed. */
  readonly changed = new Signal();
  settings: SpeakerSettings = { on: false, voice: "" };
  private readonly synthesis = (globalThis as { speechSynthesis?: SpeechSynthesis }).speechSynthesis ?? null;

  constructor(private readonly storage: TextStorage) {
    try {
      this.settings = { ...this.settings, ...(JSON.parse(storage.getItem(STORAGE_KEY) ?? "{}") as Partial<SpeakerSettings>) };
    } catch {
      // The stored value is invalid.
    }
    this.synthesis?.addEventListener("voiceschanged", () => this.changed.emit());
  }

  /** The available voices, those of the user's languages first. */
  get voices(): readonly SpeechSynthesisVoice[] {
    const { languages } = navigator;
    const rankOf = (voice: SpeechSynthesisVoice): number => {
      const index = languages.findIndex((language) => voice.lang.toLowerCase().startsWith(language.slice(0, 2).toLowerCase()));
      return index < 0 ? languages.length : index;
    };
    return [...(this.synthesis?.getVoices() ?? [])].sort((a, b) => rankOf(a) - rankOf(b) || a.name.localeCompare(b.name));
  }

  get isSpeaking(): boolean {
    return this.synthesis?.speaking ?? false;
  }

  configure(change: Partial<SpeakerSettings>): void {
    this.settings = { ...this.settings, ...change };
    this.storage.setItem(STORAGE_KEY, JSON.stringify(this.settings));
    if (!this.settings.on) this.stopSpeaking();
    this.changed.emit();
  }

  speak(text: string): void {
    if (!this.settings.on || !this.synthesis || text === "") return;
    const utterance = new SpeechSynthesisUtterance(text);
    const voice = this.voices.find(({ voiceURI }) => voiceURI === this.settings.voice);
    if (voice) {
      utterance.voice = voice;
      utterance.lang = voice.lang;
    } else if (/\p{Script=Han}/u.test(text)) utterance.lang = LANGUAGES.zh;
    this.synthesis.speak(utterance);
  }

  /** Stops speaking immediately. */
  stopSpeaking(): void {
    this.synthesis?.cancel();
  }
}
