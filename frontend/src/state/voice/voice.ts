import type { Connection } from "../../connection/connection";
import { MOST_LOST_SAMPLES, SOUND_KIND, SOUND_RATE, type ConversationPart, type TalkMode, type VoiceState as Told } from "../../protocol";
import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";
import { Microphone } from "./microphone";
import { Speaker } from "./speaker";

/** ms for which the microphone stays open after the button was released: while it opens, a word may be lost. */
const WARM_MS = 60_000;
const MOST_KEPT = 100;
/**
 * The maximum seconds missing in a word. Of synthetic words enrolled with 0.03 s missing, all were recognised; with 0.1
 * s, half.
 */
const MOST_LOST = 0.03;
const HEADER_BYTES = 16;

/** A line of the conversation. */
export interface Said {
  part: ConversationPart;
  text: string;
}

/**
 * Returns a binary frame with a block of sound and the seconds lost in it; `viewer/protocol/voice.py` defines its
 * format.
 */
export function soundFrame(samples: Int16Array, lostSeconds = 0): ArrayBuffer {
  const frame = new ArrayBuffer(HEADER_BYTES + 2 * samples.length);
  const view = new DataView(frame);
  view.setUint32(0, SOUND_KIND, true);
  view.setUint32(4, samples.length, true);
  view.setUint32(8, Math.min(MOST_LOST_SAMPLES, Math.round(lostSeconds * SOUND_RATE)), true);
  samples.forEach((sample, i) => view.setInt16(HEADER_BYTES + 2 * i, sample, true));
  return frame;
}

/** The state for talking to the robot: the button, the microphone and the conversation. */
export class VoiceState {
  readonly changed = new Signal();
  /** A line was added to the conversation, or the partial text changed. */
  readonly conversed = new Signal();
  /** The lines of the conversation, oldest first. */
  readonly history: Said[] = [];
  /** The text recognised so far of the current utterance. */
  partial = "";
  /** The server's state; null while it is not requested. */
  told: Told | null = null;
  readonly speaker: Speaker;
  private readonly watching = new Set<object>();
  private pressed = false;
  /** Whether the button was released, but the last sound is not sent yet. */
  private ending = false;
  private listening = false;
  private taking = false;
  private mode: TalkMode = "off";
  private timer = 0;
  /** The seconds that the microphone had lost before the current utterance. */
  private lostBefore = 0;
  private isAnswered = false;
  /** The seconds that it had lost up to the last block. */
  private lostUntil = 0;

  constructor(
    private readonly connection: Connection,
    storage: TextStorage,
    readonly microphone: Microphone = new Microphone(),
  ) {
    this.speaker = new Speaker(storage);
    connection.on("voice_state", (told) => {
      this.told = told;
      if (told.cut) this.release();
      this.changed.emit();
    });
    connection.on("conversation_text", ({ part, text }) => this.take(part, text));
    connection.on("hello", () => {
      this.mode = "off";
      this.announce();
      if (this.watched) this.connection.send({ type: "watch_voice", watched: true });
    });
    connection.stateChanged.on((state) => {
      if (state === "connected") return;
      this.told = null;
      this.release();
      this.changed.emit();
    });
    microphone.block.on((samples) => this.send(samples));
    microphone.changed.on(() => {
      if (microphone.problem !== null) this.listening = this.pressed = this.taking = false;
      this.announce();
      this.changed.emit();
    });
    this.speaker.changed.on(() => {
      this.watch(this.speaker, this.speaker.settings.on);
      this.changed.emit();
    });
    this.watch(this.speaker, this.speaker.settings.on);
  }

  /** Whether the button is held. */
  get held(): boolean {
    return this.pressed;
  }

  /** Whether the page listens all the time. */
  get open(): boolean {
    return this.listening;
  }

  get watched(): boolean {
    return this.watching.size > 0;
  }

  /** Whether too much sound was lost in the current or last utterance or recording. */
  get hasGaps(): boolean {
    return !this.listening && this.microphone.lostSeconds - this.lostBefore > MOST_LOST;
  }

  /** Whether the robot has answered since the button was last pressed; in that case it asks for a repetition itself. */
  get answered(): boolean {
    return this.isAnswered;
  }

  /** Starts or stops receiving the conversation for `who`. */
  watch(who: object, wanted: boolean): void {
    const before = this.watched;
    if (wanted) this.watching.add(who);
    else this.watching.delete(who);
    if (this.watched === before) return;
    if (!this.watched) this.told = null;
    this.connection.send({ type: "watch_voice", watched: this.watched });
  }

  /** Handles a press of the button: speech from now on is a command. */
  press(): void {
    if (this.pressed) return;
    this.pressed = true;
    this.isAnswered = false;
    this.lostBefore = this.microphone.lostSeconds;
    this.speaker.hush();
    this.watch(this.microphone, true);
    this.use();
  }

  /** Handles the release of the button. */
  release(): void {
    if (!this.pressed) return;
    this.pressed = false;
    this.ending = this.mode === "held";
    this.changed.emit();
    void this.microphone.flush().then(() => {
      this.ending = false;
      this.announce();
      this.rest();
    });
  }

  /** Listens all the time, or only while the button is held. */
  setOpen(open: boolean): void {
    if (open === this.listening) return;
    this.listening = open;
    this.watch(this.microphone, true);
    if (open) this.use();
    else {
      this.announce();
      this.rest();
    }
    this.changed.emit();
  }

  /** Releases the button and the microphone, for example when the page is hidden. */
  letGo(): void {
    this.release();
    if (!this.listening) this.microphone.close();
  }

  /** Whether the current speech is a recording of a word rather than a command. */
  get recording(): boolean {
    return this.taking;
  }

  /**
   * Opens the microphone for a recording; `begun` is called before the first sound is sent, and cancels the recording
   * by returning false.
   */
  async record(begun: () => boolean): Promise<boolean> {
    this.speaker.hush();
    this.setOpen(false);
    clearTimeout(this.timer);
    const opened = await this.microphone.open();
    this.lostBefore = this.microphone.lostSeconds;
    this.announce();
    this.taking = opened && begun();
    if (!this.taking) this.rest();
    return this.taking;
  }

  /** Ends the recording; resolves once its last sound is sent. */
  async endRecord(): Promise<void> {
    await this.microphone.flush();
    this.taking = false;
    this.rest();
  }

  say(text: string): void {
    this.connection.send({ type: "say_command", text });
  }

  clear(): void {
    this.history.length = 0;
    this.partial = "";
    this.conversed.emit();
  }

  /** Returns the state for `window.linkwright`. */
  inspect(): object {
    const { history, partial, told, microphone, mode, recording } = this;
    const { problem, isOpen, peak } = microphone;
    return { mode, recording, problem, isOpen, peak, partial, told, history: history.map((each) => ({ ...each })) };
  }

  private use(): void {
    clearTimeout(this.timer);
    void this.microphone.open().then((opened) => {
      if (opened) this.rest();
    });
    this.announce();
    this.changed.emit();
  }

  /** Closes the microphone after a while, unless it is needed. */
  private rest(): void {
    clearTimeout(this.timer);
    if (this.pressed || this.listening || this.taking || !this.microphone.isOpen) return;
    this.timer = window.setTimeout(() => this.microphone.close(), WARM_MS);
  }

  private announce(): void {
    const mode = this.wanted;
    if (mode === this.mode) return;
    this.mode = mode;
    this.connection.send({ type: "talk", mode });
  }

  private get wanted(): TalkMode {
    if (!this.microphone.isOpen) return "off";
    if (this.pressed || this.ending) return "held";
    return this.listening ? "open" : "ready";
  }

  private send(samples: Int16Array): void {
    this.changed.emit();
    const lost = this.microphone.lostSeconds - this.lostUntil;
    this.lostUntil = this.microphone.lostSeconds;
    if (this.mode !== "held" && this.mode !== "open" && !this.taking) return;
    // The page's own speech is not a command.
    if (this.mode === "open" && this.speaker.speaking) return;
    this.connection.sendBytes(soundFrame(samples, lost));
  }

  private take(part: ConversationPart, text: string): void {
    if (part === "response") this.isAnswered = true;
    if (part === "partial") this.partial = text;
    else {
      if (part === "text") this.partial = "";
      if (text !== "") this.history.push({ part, text });
      if (this.history.length > MOST_KEPT) this.history.shift();
      if (part === "response") this.speaker.speak(text);
    }
    this.conversed.emit();
  }
}
