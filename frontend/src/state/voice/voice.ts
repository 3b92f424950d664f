import type { Connection } from "../../connection/connection";
import { MAX_LOST_SAMPLES, SOUND_KIND, SOUND_RATE, type ConversationPart, type TalkMode, type VoiceState as ServerState } from "../../protocol";
import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";
import { Microphone } from "./microphone";
import { Speaker } from "./speaker";

/**
 * The time for which the microphone stays open after the button was released, ms: a word may be lost while it opens.
 */
const OPEN_AFTER_USE_MS = 60_000;
const MAX_HISTORY_LINES = 100;
/**
 * The maximum seconds missing in a word. Of synthetic words enrolled with 0.03 s missing, all were recognized; with 0.1
 * s, half.
 */
const MAX_LOST_S = 0.03;
const HEADER_BYTES = 16;

/** A line of the conversation. */
export interface ConversationLine {
  part: ConversationPart;
  text: string;
}

/**
 * Returns a binary frame with a block of sound and the seconds lost in it; `page/protocol/voice.py` defines its
 * format.
 */
export function encodeSound(samples: Int16Array, lostSeconds = 0): ArrayBuffer {
  const frame = new ArrayBuffer(HEADER_BYTES + 2 * samples.length);
  const view = new DataView(frame);
  view.setUint32(0, SOUND_KIND, true);
  view.setUint32(4, samples.length, true);
  view.setUint32(8, Math.min(MAX_LOST_SAMPLES, Math.round(lostSeconds * SOUND_RATE)), true);
  samples.forEach((sample, i) => view.setInt16(HEADER_BYTES + 2 * i, sample, true));
  return frame;
}

/** The state for talking to the robot: the button, the microphone and the conversation. */
export class VoiceState {
  readonly changed = new Signal();
  /** A line was added to the conversation, or the partial text changed. */
  readonly conversationChanged = new Signal();
  /** The lines of the conversation, oldest first. */
  readonly history: ConversationLine[] = [];
  /** The text recognized so far of the current utterance. */
  partial = "";
  /** The server's state; null while it is not requested. */
  serverState: ServerState | null = null;
  readonly speaker: Speaker;
  private readonly watchers = new Set<object>();
  private isPressed = false;
  /** Whether the button was released, but the last sound is not sent yet. */
  private isFlushing = false;
  private isListening = false;
  private isRecordingWord = false;
  private mode: TalkMode = "off";
  private timer = 0;
  /** The seconds that the microphone had lost before the current utterance. */
  private lostSecondsBefore = 0;
  private isAnswered = false;
  /** The seconds that it had lost up to the last block. */
  private lostSecondsUntil = 0;

  constructor(
    private readonly connection: Connection,
    storage: TextStorage,
    readonly microphone: Microphone = new Microphone(),
  ) {
    this.speaker = new Speaker(storage);
    connection.on("voice_state", (state) => {
      this.serverState = state;
      if (state.cut) this.release();
      this.changed.emit();
    });
    connection.on("conversation_text", ({ part, text }) => this.addText(part, text));
    connection.on("hello", () => {
      this.mode = "off";
      this.sendMode();
      if (this.isWatched) this.connection.send({ type: "watch_voice", watched: true });
    });
    connection.stateChanged.on((state) => {
      if (state === "connected") return;
      this.serverState = null;
      this.release();
      this.changed.emit();
    });
    microphone.block.on((samples) => this.send(samples));
    microphone.changed.on(() => {
      if (microphone.problem !== null) this.isListening = this.isPressed = this.isRecordingWord = false;
      this.sendMode();
      this.changed.emit();
    });
    this.speaker.changed.on(() => {
      this.watch(this.speaker, this.speaker.settings.on);
      this.changed.emit();
    });
    this.watch(this.speaker, this.speaker.settings.on);
  }

  /** Whether the button is held. */
  get isHeld(): boolean {
    return this.isPressed;
  }

  /** Whether the page listens all the time. */
  get isAlwaysListening(): boolean {
    return this.isListening;
  }

  get isWatched(): boolean {
    return this.watchers.size > 0;
  }

  /** Whether too much sound was lost in the current or last utterance or recording. */
  get hasGaps(): boolean {
    return !this.isListening && this.microphone.lostSeconds - this.lostSecondsBefore > MAX_LOST_S;
  }

  /** Whether the robot has answered since the button was last pressed; in that case it asks for a repetition itself. */
  get hasAnswer(): boolean {
    return this.isAnswered;
  }

  /** Starts or stops receiving the conversation for a panel. */
  watch(watcher: object, isWatching: boolean): void {
    const wasWatched = this.isWatched;
    if (isWatching) this.watchers.add(watcher);
    else this.watchers.delete(watcher);
    if (this.isWatched === wasWatched) return;
    if (!this.isWatched) this.serverState = null;
    this.connection.send({ type: "watch_voice", watched: this.isWatched });
  }

  /** Handles a press of the button: speech from now on is a command. */
  press(): void {
    if (this.isPressed) return;
    this.isPressed = true;
    this.isAnswered = false;
    this.lostSecondsBefore = this.microphone.lostSeconds;
    this.speaker.stopSpeaking();
    this.watch(this.microphone, true);
    this.openMicrophone();
  }

  /** Handles the release of the button. */
  release(): void {
    if (!this.isPressed) return;
    this.isPressed = false;
    this.isFlushing = this.mode === "held";
    this.changed.emit();
    void this.microphone.flush().then(() => {
      this.isFlushing = false;
      this.sendMode();
      this.scheduleClose();
    });
  }

  /** Listens all the time, or only while the button is held. */
  setAlwaysListening(isOpen: boolean): void {
    if (isOpen === this.isListening) return;
    this.isListening = isOpen;
    this.watch(this.microphone, true);
    if (isOpen) this.openMicrophone();
    else {
      this.sendMode();
      this.scheduleClose();
    }
    this.changed.emit();
  }

  /** Releases the button and the microphone, for example when the page is hidden. */
  releaseMicrophone(): void {
    this.release();
    if (!this.isListening) this.microphone.close();
  }

  /** Whether the current speech is a recording of a word rather than a command. */
  get isRecording(): boolean {
    return this.isRecordingWord;
  }

  /**
   * Opens the microphone for a recording; `onBegin` is called before the first sound is sent, and cancels the
   * recording by returning false.
   */
  async startRecording(onBegin: () => boolean): Promise<boolean> {
    this.speaker.stopSpeaking();
    this.setAlwaysListening(false);
    clearTimeout(this.timer);
    const isOpen = await this.microphone.open();
    this.lostSecondsBefore = this.microphone.lostSeconds;
    this.sendMode();
    this.isRecordingWord = isOpen && onBegin();
    if (!this.isRecordingWord) this.scheduleClose();
    return this.isRecordingWord;
  }

  /** Ends the recording; resolves once its last sound is sent. */
  async endRecording(): Promise<void> {
    await this.microphone.flush();
    this.isRecordingWord = false;
    this.scheduleClose();
  }

  sendCommand(text: string): void {
    this.connection.send({ type: "say_command", text });
  }

  clear(): void {
    this.history.length = 0;
    this.partial = "";
    this.conversationChanged.emit();
  }

  /** Returns the state for `window.linkwright`. */
  inspect(): object {
    const { history, partial, serverState, microphone, mode, isRecording } = this;
    const { problem, isOpen, peak } = microphone;
    return { mode, recording: isRecording, problem, isOpen, peak, partial, serverState, history: history.map((line) => ({ ...line })) };
  }

  private openMicrophone(): void {
    clearTimeout(this.timer);
    void this.microphone.open().then((isOpen) => {
      if (isOpen) this.scheduleClose();
    });
    this.sendMode();
    this.changed.emit();
  }

  /** Closes the microphone after a while, unless it is needed. */
  private scheduleClose(): void {
    clearTimeout(this.timer);
    if (this.isPressed || this.isListening || this.isRecordingWord || !this.microphone.isOpen) return;
    this.timer = window.setTimeout(() => this.microphone.close(), OPEN_AFTER_USE_MS);
  }

  private sendMode(): void {
    const mode = this.requiredMode;
    if (mode === this.mode) return;
    this.mode = mode;
    this.connection.send({ type: "talk", mode });
  }

  private get requiredMode(): TalkMode {
    if (!this.microphone.isOpen) return "off";
    if (this.isPressed || this.isFlushing) return "held";
    return this.isListening ? "open" : "ready";
  }

  private send(samples: Int16Array): void {
    this.changed.emit();
    const lostSeconds = this.microphone.lostSeconds - this.lostSecondsUntil;
    this.lostSecondsUntil = this.microphone.lostSeconds;
    if (this.mode !== "held" && this.mode !== "open" && !this.isRecordingWord) return;
    // The page's own speech is not a command.
    if (this.mode === "open" && this.speaker.isSpeaking) return;
    this.connection.sendBytes(encodeSound(samples, lostSeconds));
  }

  private addText(part: ConversationPart, text: string): void {
    if (part === "response") this.isAnswered = true;
    if (part === "partial") this.partial = text;
    else {
      if (part === "text") this.partial = "";
      if (text !== "") this.history.push({ part, text });
      if (this.history.length > MAX_HISTORY_LINES) this.history.shift();
      if (part === "response") this.speaker.speak(text);
    }
    this.conversationChanged.emit();
  }
}
