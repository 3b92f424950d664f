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

/** The panel for talking to the robot, with the recognized texts, the commands and the responses. */
export class VoicePanel implements Panel {
  readonly id = "voice";
  readonly icon = "microphone";
  readonly element: HTMLElement;
  private readonly meter = new LevelMeter(strings.voice.level);
  private readonly state = h("div", { class: "voice-state", role: "status" });
  private readonly history = h("div", { class: "voice-history", role: "log", tabIndex: 0, aria: { label: strings.voice.history } });
  private readonly openMicrophoneBox: ReturnType<typeof tickBox>;
  private readonly proposal: HTMLElement;
  private readonly wordsBox: WordsBox;
  private readonly textNote = h("p", { class: "note" }, strings.voice.noTextListener);
  private readonly speakBox: ReturnType<typeof tickBox>;
  private readonly voices: HTMLSelectElement;
  private readonly noVoices = h("p", { class: "note" }, strings.voice.noVoices);

  constructor(
    private readonly voice: VoiceState,
    private readonly enrolled: WordsState,
  ) {
    const texts = strings.voice;
    const { speaker } = voice;
    this.openMicrophoneBox = tickBox(texts.open, texts.openHint, (ticked) => voice.setOpen(ticked));
    this.speakBox = tickBox(texts.speak, texts.speakHint, (on) => speaker.configure({ on }));
    this.voices = choice(texts.voice, [], (chosen) => speaker.configure({ voice: chosen }));
    const wordsBox = (this.wordsBox = new WordsBox(enrolled, voice));
    this.proposal = h("div", { class: "voice-proposal", role: "status" }, h("span", {}, texts.words.proposal), enrollHereButton(enrolled));
    const clear = button(texts.clearHint, () => voice.clear(), "tool bare", icon("clear"));
    this.element = h(
      "div",
      { class: "panel monitor" },
      h(
        "div",
        { class: "scroll voice" },
        h("div", { class: "voice-main" }, talkButton(voice, "tool framed voice-talk", texts.talkWithKey), this.meter.element),
        h("div", { class: "voice-row" }, this.openMicrophoneBox, h("span", { class: "spacer" }), clear),
        this.state,
        this.proposal,
        this.history,
        this.commandForm(),
        h("div", { class: "voice-row" }, this.speakBox, this.voices),
        this.noVoices,
        wordsBox.element,
      ),
    );
    voice.changed.on(() => this.show());
    enrolled.changed.on(() => this.show());
    voice.conversed.on(() => this.showHistory());
    onVisibilityChange(this.element, (seen) => {
      voice.watch(this, seen);
      wordsBox.watch(seen);
    });
    this.show();
    this.showHistory();
  }

  /** Starts to enroll the words again at the user's location. */
  enrollHere(): void {
    this.wordsBox.enrollHere();
  }

  private commandForm(): HTMLElement {
    const texts = strings.voice;
    const send = (): void => {
      const text = field.value.trim();
      if (text === "") return;
      this.voice.sendCommand(text);
      field.value = "";
    };
    const field = textField(texts.command, () => undefined);
    field.placeholder = texts.commandShort;
    field.maxLength = 200;
    field.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && !event.isComposing) send();
    });
    const sending = button(texts.sendHint, send, "tool framed", texts.send);
    return h("div", { class: "voice-command" }, h("div", { class: "voice-row" }, field, sending), this.textNote);
  }

  private show(): void {
    const { voice } = this;
    const { speaker, serverState, microphone } = voice;
    const problem = obstacle(voice);
    const text = problem ?? activity(voice);
    if (this.state.textContent !== text) this.state.textContent = text;
    this.state.classList.toggle("wrong", problem !== null);
    this.meter.show(microphone.isOpen ? microphone.peak : null);
    this.openMicrophoneBox.box.checked = voice.isPanelOpen;
    this.proposal.hidden = !proposesEnrolling(voice, this.enrolled);
    this.textNote.hidden = serverState?.text_listeners !== 0;
    this.speakBox.box.checked = speaker.settings.on;
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
    const texts = strings.voice;
    const row = (part: ConversationPart, text: string): HTMLElement =>
      h("div", { class: `voice-said ${part}` }, h("span", { title: texts.parts[part] }, icon(ICONS[part])), h("span", { class: "voice-part" }, texts.parts[part]), h("span", {}, text));
    const rows = history.map(({ part, text }) => row(part, text));
    if (partial !== "") rows.push(row("partial", partial));
    const atEnd = this.history.scrollTop + this.history.clientHeight >= this.history.scrollHeight - 4;
    this.history.replaceChildren(...(rows.length > 0 ? rows : [h("p", { class: "note" }, texts.nothing)]));
    if (atEnd) this.history.scrollTop = this.history.scrollHeight;
  }
}
