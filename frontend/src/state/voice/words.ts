import type { Connection } from "../../connection/connection";
import type { EnrolledWord, TakeJudged } from "../../protocol";
import { Signal } from "../../signal";
import type { VoiceState } from "./voice";

/** The time for which a recording continues after the button was released, ms, because the end of a word is soft. */
const EXTRA_RECORDING_MS = 300;

/** The words that the user enrolls. */
export class WordsState {
  readonly changed = new Signal();
  /** The text of the words file arrived. */
  readonly fileArrived = new Signal<string>();
  /** The user asked to enroll the words at their current place. */
  readonly enrollRequested = new Signal();
  words: readonly EnrolledWord[] = [];
  /** The number of recordings needed for each word. */
  requiredTakes = 3;
  file = "";
  problem: string | null = null;
  /** The result of the last recording of each word. */
  readonly judgments = new Map<string, TakeJudged>();
  /** The word being recorded. */
  recording: string | null = null;
  /** The number of recordings of each word at the user's current place; null while the user does not enroll there. */
  takesHere: Map<string, number> | null = null;
  /** Words that were added but have no recording yet. */
  private readonly newWords = new Set<string>();
  private isWatched = false;

  constructor(
    private readonly connection: Connection,
    private readonly voice: VoiceState,
  ) {
    connection.on("voice_words", ({ words, enough, file, problem }) => {
      Object.assign(this, { words, requiredTakes: enough, file, problem });
      for (const { name } of words) this.newWords.delete(name);
      this.changed.emit();
    });
    connection.on("take_judged", (judgment) => {
      this.judgments.set(judgment.name, judgment);
      if (judgment.code === null) this.takesHere?.set(judgment.name, (this.takesHere.get(judgment.name) ?? 0) + 1);
      this.changed.emit();
    });
    connection.on("voice_words_file", ({ text }) => this.fileArrived.emit(text));
    connection.on("hello", () => {
      if (this.isWatched) connection.send({ type: "watch_words", watched: true });
    });
  }

  /** All words, including those without a recording. */
  get allWords(): readonly EnrolledWord[] {
    return [...this.words, ...[...this.newWords].map((name) => ({ name, takes: 0 }))];
  }

  /** The words still to be recorded at the user's current place. */
  get missingHere(): readonly EnrolledWord[] {
    return this.allWords.filter(({ name }) => (this.takesHere?.get(name) ?? 0) < this.requiredTakes);
  }

  /** Starts or ends enrollment at the user's current place. */
  setEnrollingHere(isEnrolling: boolean): void {
    this.takesHere = isEnrolling ? new Map<string, number>() : null;
    this.changed.emit();
  }

  watch(isWatched: boolean): void {
    if (isWatched === this.isWatched) return;
    this.isWatched = isWatched;
    this.connection.send({ type: "watch_words", watched: isWatched });
  }

  /** Adds a word to the list, to be recorded. */
  addWord(name: string): void {
    const newWord = name.trim();
    if (newWord === "" || this.allWords.some((word) => word.name === newWord)) return;
    this.newWords.add(newWord);
    this.changed.emit();
  }

  /** Starts the recording of a word. */
  async startTake(name: string): Promise<void> {
    if (this.recording !== null) return;
    this.recording = name;
    this.judgments.delete(name); // later judgments are about this recording
    this.changed.emit();
    const hasBegun = await this.voice.startRecording(() => {
      if (this.recording === name) this.connection.send({ type: "begin_take", name });
      return this.recording === name;
    });
    if (!hasBegun && this.recording === name) this.stop();
    else this.changed.emit();
  }

  /** Ends the recording. */
  endTake(): void {
    if (this.recording === null) return;
    if (!this.voice.isRecording) {
      this.stop();
      return;
    }
    window.setTimeout(() => {
      void this.voice.endRecording().then(() => {
        this.connection.send({ type: "end_take", has_gaps: this.voice.hasGaps });
        this.stop();
      });
    }, EXTRA_RECORDING_MS);
  }

  remove(name: string): void {
    this.judgments.delete(name);
    if (this.newWords.delete(name)) this.changed.emit();
    else this.connection.send({ type: "remove_word", name });
  }

  rename(name: string, newName: string): void {
    if (this.newWords.delete(name)) this.addWord(newName);
    else this.connection.send({ type: "rename_word", name, new_name: newName });
  }

  importFile(text: string): void {
    this.connection.send({ type: "import_words", text });
  }

  requestFile(): void {
    this.connection.send({ type: "request_words_file" });
  }

  /** Whether the word can be spoken now: its button is held and the microphone is open. */
  get isReadyForSpeech(): boolean {
    return this.recording !== null && this.voice.isRecording;
  }

  private stop(): void {
    this.recording = null;
    this.changed.emit();
  }
}
