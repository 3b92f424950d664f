import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { ConversationPart } from "../../protocol";
import type { VoiceState } from "../../state/voice/voice";
import type { WordsState } from "../../state/voice/words";
import { strings } from "../../strings";
import { createSelect, createTextField, createTickBox } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { createEnrollHereButton, proposesEnrolling } from "./enroll-here";
import { LevelMeter } from "./level-meter";
import { createTalkButton } from "./talk-button";
import { describeActivity, describeObstacle } from "./voice-words";
import { WordsBox } from "./words-box";

const PART_ICONS = { partial: "microphone", text: "microphone", command: "check", response: "speech" } as const satisfies Record<ConversationPart, string>;

/** The panel for talking to the robot, with the recognized texts, the commands and the responses. */
export class VoicePanel implements Panel {
  readonly id = "voice";
  readonly icon = "microphone";
  readonly element: HTMLElement;
  private readonly meter = new LevelMeter(strings.voice.level);
  private readonly stateText = h("div", { class: "voice-state", role: "status" });
  private readonly historyBox = h("div", { class: "voice-history", role: "log", tabIndex: 0, aria: { label: strings.voice.history } });
  private readonly openMicrophoneBox: ReturnType<typeof createTickBox>;
  private readonly enrollProposal: HTMLElement;
  private readonly wordsBox: WordsBox;
  private readonly textNote = h("p", { class: "note" }, strings.voice.noTextListener);
  private readonly speakBox: ReturnType<typeof createTickBox>;
  private readonly voiceSelect: HTMLSelectElement;
  private readonly noVoicesNote = h("p", { class: "note" }, strings.voice.noVoices);

  constructor(
    private readonly voice: VoiceState,
    private readonly words: WordsState,
  ) {
    const texts = strings.voice;
    const { speaker } = voice;
    this.openMicrophoneBox = createTickBox(texts.open, texts.openHint, (isTicked) => voice.setAlwaysListening(isTicked));
    this.speakBox = createTickBox(texts.speak, texts.speakHint, (isTicked) => speaker.configure({ on: isTicked }));
    this.voiceSelect = createSelect(texts.voice, [], (voiceUri) => speaker.configure({ voice: voiceUri }));
    const wordsBox = (this.wordsBox = new WordsBox(words, voice));
    this.enrollProposal = h("div", { class: "voice-proposal", role: "status" }, h("span", {}, texts.words.proposal), createEnrollHereButton(words));
    const clearButton = createButton(texts.clearHint, () => voice.clear(), "tool bare", createIcon("clear"));
    this.element = h(
      "div",
      { class: "panel monitor" },
      h(
        "div",
        { class: "scroll voice" },
        h("div", { class: "voice-main" }, createTalkButton(voice, "tool framed voice-talk", texts.talkWithKey), this.meter.element),
        h("div", { class: "voice-row" }, this.openMicrophoneBox, h("span", { class: "spacer" }), clearButton),
        this.stateText,
        this.enrollProposal,
        this.historyBox,
        this.createCommandForm(),
        h("div", { class: "voice-row" }, this.speakBox, this.voiceSelect),
        this.noVoicesNote,
        wordsBox.element,
      ),
    );
    voice.changed.on(() => this.show());
    words.changed.on(() => this.show());
    voice.conversationChanged.on(() => this.showHistory());
    onVisibilityChange(this.element, (isVisible) => {
      voice.watch(this, isVisible);
      wordsBox.watch(isVisible);
    });
    this.show();
    this.showHistory();
  }

  /** Starts to enroll the words again at the user's location. */
  enrollHere(): void {
    this.wordsBox.enrollHere();
  }

  private createCommandForm(): HTMLElement {
    const texts = strings.voice;
    const send = (): void => {
      const text = field.value.trim();
      if (text === "") return;
      this.voice.sendCommand(text);
      field.value = "";
    };
    const field = createTextField(texts.command, () => undefined);
    field.placeholder = texts.commandShort;
    field.maxLength = 200;
    field.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && !event.isComposing) send();
    });
    const sendButton = createButton(texts.sendHint, send, "tool framed", texts.send);
    return h("div", { class: "voice-command" }, h("div", { class: "voice-row" }, field, sendButton), this.textNote);
  }

  private show(): void {
    const { voice } = this;
    const { speaker, serverState, microphone } = voice;
    const problem = describeObstacle(voice);
    const text = problem ?? describeActivity(voice);
    if (this.stateText.textContent !== text) this.stateText.textContent = text;
    this.stateText.classList.toggle("wrong", problem !== null);
    this.meter.show(microphone.isOpen ? microphone.peak : null);
    this.openMicrophoneBox.box.checked = voice.isAlwaysListening;
    this.enrollProposal.hidden = !proposesEnrolling(voice, this.words);
    this.textNote.hidden = serverState?.text_listeners !== 0;
    this.speakBox.box.checked = speaker.settings.on;
    this.showVoices();
  }

  private showVoices(): void {
    const { speaker } = this.voice;
    const { voices, settings } = speaker;
    if (this.voiceSelect.options.length !== voices.length + 1) {
      this.voiceSelect.replaceChildren(
        new Option(strings.voice.anyVoice, ""),
        ...voices.map(({ name, lang, voiceURI }) => new Option(`${name} (${lang})`, voiceURI)),
      );
    }
    this.voiceSelect.value = voices.some(({ voiceURI }) => voiceURI === settings.voice) ? settings.voice : "";
    this.voiceSelect.hidden = voices.length === 0;
    this.noVoicesNote.hidden = !settings.on || voices.length > 0;
  }

  private showHistory(): void {
    const { history, partial } = this.voice;
    const texts = strings.voice;
    const createRow = (part: ConversationPart, text: string): HTMLElement =>
      h(
        "div",
        { class: `voice-said ${part}` },
        h("span", { title: texts.parts[part] }, createIcon(PART_ICONS[part])),
        h("span", { class: "voice-part" }, texts.parts[part]),
        h("span", {}, text),
      );
    const rows = history.map(({ part, text }) => createRow(part, text));
    if (partial !== "") rows.push(createRow("partial", partial));
    const isAtEnd = this.historyBox.scrollTop + this.historyBox.clientHeight >= this.historyBox.scrollHeight - 4;
    this.historyBox.replaceChildren(...(rows.length > 0 ? rows : [h("p", { class: "note" }, texts.nothing)]));
    if (isAtEnd) this.historyBox.scrollTop = this.historyBox.scrollHeight;
  }
}
