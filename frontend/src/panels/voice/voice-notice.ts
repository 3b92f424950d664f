import { h } from "../../dom";
import { icon } from "../../icons";
import type { VoiceState } from "../../state/voice/voice";
import type { WordsState } from "../../state/voice/words";
import { enrollHereButton, proposesEnrolling } from "./enroll-here";
import { activity, obstacle } from "./voice-words";

const SHOWN_MS = 7000;

/**
 * The notice over the scene that shows whether the page listens, the words recognized so far, the result, or the
 * obstacle.
 */
export class VoiceNotice {
  readonly element = h("div", { class: "voice-notice", role: "status" });
  private readonly text = h("span");
  private readonly enroll: HTMLButtonElement;
  private timer = 0;
  private shown = "";

  constructor(
    private readonly voice: VoiceState,
    private readonly words: WordsState,
  ) {
    this.enroll = enrollHereButton(words);
    this.element.append(icon("microphone"), this.text, this.enroll);
    this.element.hidden = true;
    voice.changed.on(() => this.show());
    voice.conversed.on(() => this.show());
    words.changed.on(() => this.show());
  }

  private show(): void {
    const { voice } = this;
    const wrong = obstacle(voice);
    const busy = voice.isHeld || voice.isPanelOpen;
    const last = voice.history.at(-1)?.text ?? "";
    const text = wrong ?? (voice.partial || (busy ? activity(voice) : last));
    const proposes = !busy && wrong === null && proposesEnrolling(voice, this.words);
    const key = `${String(busy)}${String(wrong !== null)}${String(proposes)}${text}`;
    if (key === this.shown) return;
    this.shown = key;
    this.text.textContent = text;
    this.element.classList.toggle("wrong", wrong !== null);
    this.element.classList.toggle("talking", busy && wrong === null);
    this.enroll.hidden = !proposes;
    this.element.hidden = text === "";
    clearTimeout(this.timer);
    if (!busy && !proposes) this.timer = window.setTimeout(() => (this.element.hidden = true), SHOWN_MS);
  }
}
