import { button, h } from "../../dom";
import { icon } from "../../icons";
import type { ConversationPart } from "../../protocol";
import type { VoiceState } from "../../state/voice/voice";
import type { WordsState } from "../../state/voice/words";
import { strings } from "../../strings";
import { choice, textField, tickBox } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { enrollHereButton, proposesEnrolling } from "./enroll-here";
import { LevelMeter } from "./level-meter";
import { talkButton } from "./talk-button";
import { activity, obstacle } from "./voice-words";
import { WordsBox } from "./words-box";

const ICONS = { partial: "microphone", text: "microphone", command: "check", response: "speech" } as const satisfies Record<ConversationPart, string>;

/** The panel for talking to the robot, with what it heard, understood and answered. */
export class VoicePanel implements Panel {
  readonly id = "voice";
  readonly icon = "microphone";
  readonly element: HTMLElement;
  private readonly meter = new LevelMeter(strings.voice.level);
  private readonly state = h("div", { class: "voice-state", role: "status" });
  private readonly history = h("div", { class: "voice-history", role: "log", tabIndex: 0, aria: { label: strings.voice.history } });
  private readonly open: ReturnType<typeof tickBox>;
  private readonly proposal: HTMLElement;
  private readonly box: WordsBox;
  private readonly textNote = h("p", { class: "note" }, strings.voice.noTextListener);
  private readonly speak: ReturnType<typeof tickBox>;
  private readonly voices: HTMLSelectElement;
  private readonly noVoices = h("p", { class: "note" }, strings.voice.noVoices);

  constructor(
    private readonly voice: VoiceState,
    private readonly enrolled: WordsState,
  ) {
    const words = strings.voice;
    const { speaker } = voice;
    this.open = tickBox(words.open, words.openHint, (ticked) => voice.setOpen(ticked));
    this.speak = tickBox(words.speak, words.speakHint, (on) => speaker.configure({ on }));
    this.voices = choice(words.voice, [], (chosen) => speaker.configure({ voice: chosen }));
    const box = (this.box = new WordsBox(enrolled, voice));
    this.proposal = h("div", { class: "voice-proposal", role: "status" }, h("span", {}, words.words.proposal), enrollHereButton(enrolled));
    const clear = button(words.clearHint, () => voice.clear(), "tool bare", icon("clear"));
    this.element = h(
      "div",
      { class: "panel monitor" },
      h(
        "div",
        { class: "scroll voice" },
        h("div", { class: "voice-main" }, talkButton(voice, "tool framed voice-talk", words.talkWithKey), this.meter.element),
        h("div", { class: "voice-row" }, this.open, h("span", { class: "spacer" }), clear),
        this.state,
        this.proposal,
        this.history,
        this.commandForm(),
        h("div", { class: "voice-row" }, this.speak, this.voices),
        this.noVoices,
        box.element,
      ),
    );
    voice.changed.on(() => this.show());
    enrolled.changed.on(() => this.show());
    voice.conversed.on(() => this.showHistory());
    onVisibilityChange(this.element, (seen) => {
      voice.watch(this, seen);
      box.watch(seen);
    });
    this.show();
    this.showHistory();
  }

  /** Starts enrollment at the user's place. */
  enrollHere(): void {
    this.box.enrollHere();
  }

  private commandForm(): HTMLElement {
    const words = strings.voice;
    const send = (): void => {
      const text = field.value.trim();
      if (text === "") return;
      this.voice.sendCommand(text);
      field.value = "";
    };
    const field = textField(words.command, () => undefined);
    field.placeholder = words.commandShort;
    field.maxLength = 200;
    field.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && !event.isComposing) send();
    });
    const sending = button(words.sendHint, send, "tool framed", words.send);
    return h("div", { class: "voice-command" }, h("div", { class: "voice-row" }, field, sending), this.textNote);
  }

  private show(): void {
    const { voice } = this;
    const { speaker, serverState, microphone } = voice;
    const wrong = obstacle(voice);
    const text = wrong ?? activity(voice);
    if (this.state.textContent !== text) this.state.textContent = text;
    this.state.classList.toggle("wrong", wrong !== null);
    this.meter.show(microphone.isOpen ? microphone.peak : null);
    this.open.box.checked = voice.open;
    this.proposal.hidden = !proposesEnrolling(voice, this.enrolled);
    this.textNote.hidden = serverState?.text_listeners !== 0;
    this.speak.box.checked = speaker.settings.on;
    this.showVoices();
  }

  private showVoices(): void {
    const { speaker } = this.voice;
    const { voices, settings } = speaker;
    if (this.voices.options.length !== voices.length + 1) {
      this.voices.replaceChildren(
        new Option(strings.voice.anyVoice, ""),
        ...voices.map(({ name, lang, voiceURI }) => new Option(`${name} (${lang})`, voiceURI)),
      );
    }
    this.voices.value = voices.some(({ voiceURI }) => voiceURI === settings.voice) ? settings.voice : "";
    this.voices.hidden = voices.length === 0;
    this.noVoices.hidden = !settings.on || voices.length > 0;
  }

  private showHistory(): void {
    const { history, partial } = this.voice;
    const words = strings.voice;
    const row = (part: ConversationPart, text: string): HTMLElement =>
      h("div", { class: `voice-said ${part}` }, h("span", { title: words.parts[part] }, icon(ICONS[part])), h("span", { class: "voice-part" }, words.parts[part]), h("span", {}, text));
    const rows = history.map(({ part, text }) => row(part, text));
    if (partial !== "") rows.push(row("partial", partial));
    const atEnd = this.history.scrollTop + this.history.clientHeight >= this.history.scrollHeight - 4;
    this.history.replaceChildren(...(rows.length > 0 ? rows : [h("p", { class: "note" }, words.nothing)]));
    if (atEnd) this.history.scrollTop = this.history.scrollHeight;
  }
}
