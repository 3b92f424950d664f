import { h } from "../../dom";
import { createIcon } from "../../icons";
import type { VoiceState } from "../../state/voice/voice";
import type { WordsState } from "../../state/voice/words";
import { createEnrollHereButton, proposesEnrolling } from "./enroll-here";
import { describeActivity, describeObstacle } from "./voice-words";

const NOTICE_DURATION_MS = 7000;

/**
 * The notice over the scene that shows whether the page listens, the words recognized so far, the result, or the
 * obstacle.
 */
export class VoiceNotice {
  readonly element = h("div", { class: "voice-notice", role: "status" });
  private readonly text = h("span");
  private readonly enrollButton: HTMLButtonElement;
  private timer = 0;
  private shownKey = "";

  constructor(
    private readonly voice: VoiceState,
    private readonly words: WordsState,
  ) {
    this.enrollButton = createEnrollHereButton(words);
    this.element.append(createIcon("microphone"), this.text, this.enrollButton);
    this.element.hidden = true;
    voice.changed.on(() => this.show());
    voice.conversationChanged.on(() => this.show());
    words.changed.on(() => this.show());
  }

  private show(): void {
    const { voice } = this;
    const problem = describeObstacle(voice);
    const isTalking = voice.isHeld || voice.isAlwaysListening;
    const lastText = voice.history.at(-1)?.text ?? "";
    const text = problem ?? (voice.partial || (isTalking ? describeActivity(voice) : lastText));
    const offersEnrolling = !isTalking && problem === null && proposesEnrolling(voice, this.words);
    const key = `${String(isTalking)}${String(problem !== null)}${String(offersEnrolling)}${text}`;
    if (key === this.shownKey) return;
    this.shownKey = key;
    this.text.textContent = text;
    this.element.classList.toggle("wrong", problem !== null);
    this.element.classList.toggle("talking", isTalking && problem === null);
    this.enrollButton.hidden = !offersEnrolling;
    this.element.hidden = text === "";
    clearTimeout(this.timer);
    if (!isTalking && !offersEnrolling) this.timer = window.setTimeout(() => (this.element.hidden = true), NOTICE_DURATION_MS);
  }
}
