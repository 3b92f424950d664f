import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { EnrolledWord, TakeJudged } from "../../protocol";
import type { VoiceState } from "../../state/voice/voice";
import type { WordsState } from "../../state/voice/words";
import { strings } from "../../strings";
import { createTextField } from "../../widgets/controls";
import { askName } from "../../widgets/dialog";
import { saveText } from "../../widgets/save-file";
import { describeObstacle } from "./voice-words";

/** A recording whose peak is below this counts as quiet: -24 dB. */
const QUIET_PEAK = 0.06;

/** The words that the user enrolls. The user speaks each word three times while holding down a button. */
export class WordsBox {
  readonly element: HTMLDetailsElement;
  private readonly list = h("div", { class: "word-list", role: "list" });
  private readonly problemNote = h("p", { class: "note wrong", role: "status" });
  private readonly file = h("p", { class: "note" });
  private readonly wordField: HTMLInputElement;
  private readonly hereBox: HTMLElement;
  private readonly hereNote = h("span", { class: "note" });
  private readonly hereProgress = h("strong", { role: "status" });
  private shownNames = "";
  /** Whether the next word to speak gets the focus as soon as the words have arrived. */
  private focusesNextWord = false;

  constructor(
    private readonly words: WordsState,
    private readonly voice: VoiceState,
  ) {
    const texts = strings.voice.words;
    const addWord = (): void => {
      words.addWord(wordField.value);
      wordField.value = "";
    };
    const wordField = (this.wordField = createTextField(texts.choose, () => undefined));
    wordField.maxLength = 100;
    const suggestions = h("datalist", {}, ...texts.suggestions.map((suggestion) => new Option(suggestion)));
    suggestions.id = "voice-word-suggestions";
    wordField.setAttribute("list", suggestions.id);
    wordField.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && !event.isComposing) addWord();
    });
    const fileInput = h("input", { aria: { label: texts.importFile } });
    fileInput.type = "file";
    fileInput.accept = ".json,application/json";
    fileInput.hidden = true;
    fileInput.addEventListener("change", () => {
      const [file] = fileInput.files ?? [];
      fileInput.value = "";
      void file?.text().then((text) => words.importFile(text));
    });
    const endButton = createButton(texts.endHereHint, () => words.setEnrollingHere(false), "tool framed", texts.endHere);
    this.hereBox = h("div", { class: "word-here" }, this.hereProgress, this.hereNote, endButton);
    this.element = h(
      "details",
      { class: "word-box" },
      h("summary", {}, texts.title),
      this.hereBox,
      h("p", { class: "note" }, texts.hint),
      h("div", { class: "voice-row" }, wordField, suggestions, createButton(texts.addHint, addWord, "tool framed", texts.add)),
      this.list,
      this.problemNote,
      h(
        "div",
        { class: "voice-row" },
        createButton(texts.importHint, () => fileInput.click(), "tool framed", createIcon("upload"), texts.importFile),
        createButton(texts.exportHint, () => words.requestFile(), "tool framed", createIcon("download"), texts.exportFile),
        fileInput,
      ),
      this.file,
    );
    this.element.addEventListener("toggle", () => this.watch(true));
    words.changed.on(() => this.show());
    voice.changed.on(() => this.showProblem());
    words.fileArrived.on((text) => saveText("words.json", text, "application/json"));
    this.show();
  }

  /** Requests the words while the panel is visible and this box is open. */
  watch(isVisible: boolean): void {
    this.words.watch(isVisible && this.element.open);
  }

  /** Starts to enroll the words again at the user's location. The panel must be in front. */
  enrollHere(): void {
    this.element.open = true;
    this.focusesNextWord = true;
    this.words.setEnrollingHere(true);
    this.hereBox.scrollIntoView({ block: "nearest" });
  }

  private show(): void {
    const { words } = this;
    const enrolledWords = words.allWords;
    const key = JSON.stringify(enrolledWords.map(({ name }) => name));
    // Replace the rows only if words changed: a button that is held must stay in place.
    if (key !== this.shownNames) {
      this.shownNames = key;
      this.list.replaceChildren(...enrolledWords.map((word) => this.createRow(word)));
    }
    enrolledWords.forEach((word, index) => this.updateRow(this.list.children[index], word));
    this.showProblem();
    this.showHere();
    this.file.textContent = words.file === "" ? "" : strings.voice.words.keptIn(words.file);
  }

  private showProblem(): void {
    const problem = this.words.problem ?? (this.voice.microphone.problem === null ? null : describeObstacle(this.voice));
    if (this.problemNote.textContent !== problem) this.problemNote.textContent = problem;
    this.problemNote.hidden = problem === null;
  }

  private showHere(): void {
    const { allWords: words, takesHere, missingHere, requiredTakes, file } = this.words;
    const texts = strings.voice.words;
    this.hereBox.hidden = takesHere === null;
    if (takesHere === null) return;
    const [nextWord] = missingHere;
    const doneCount = words.length - missingHere.length;
    const progress = words.length === 0 ? texts.hereNone : nextWord ? texts.hereDone(doneCount, words.length) : texts.hereAll;
    if (this.hereProgress.textContent !== progress) this.hereProgress.textContent = progress;
    this.hereNote.textContent = texts.here(requiredTakes);
    if (!this.focusesNextWord || file === "") return;
    this.focusesNextWord = false;
    const row = nextWord && this.list.children[words.indexOf(nextWord)];
    (row?.querySelector<HTMLElement>(".word-say") ?? this.wordField).focus();
  }

  private createRow({ name }: EnrolledWord): HTMLElement {
    const texts = strings.voice.words;
    const { words } = this;
    const sayButton = createButton(texts.say(name), () => undefined, "tool framed word-say", createIcon("microphone"));
    const startTake = (): void => void words.startTake(name);
    const endTake = (): void => {
      if (words.recording === name) words.endTake();
    };
    sayButton.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      sayButton.setPointerCapture(event.pointerId);
      startTake();
    });
    for (const eventType of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) sayButton.addEventListener(eventType, endTake);
    sayButton.addEventListener("keydown", (event) => {
      if (event.key !== " " && event.key !== "Enter") return;
      event.preventDefault();
      if (!event.repeat) startTake();
    });
    sayButton.addEventListener("keyup", (event) => {
      if (event.key === " " || event.key === "Enter") endTake();
    });
    const renameButton = createButton(texts.rename(name), () => askName(texts.renameTitle, texts.name, name, (newName) => words.rename(name, newName)), "tool bare", createIcon("rename"));
    const removeButton = createButton(texts.remove(name), () => words.remove(name), "tool bare", createIcon("remove"));
    const head = h("div", { class: "word-head" }, sayButton, h("span", { class: "word-name" }, name), h("span", { class: "word-takes note" }), renameButton, removeButton);
    return h("div", { class: "word", role: "listitem" }, head, h("div", { class: "note word-judged", role: "status" }));
  }

  private updateRow(row: Element | undefined, { name, takes }: EnrolledWord): void {
    const { recording, isReadyForSpeech, requiredTakes, judgments, takesHere } = this.words;
    const texts = strings.voice.words;
    const findPart = (selector: string): Element | null => row?.querySelector(selector) ?? null;
    const countElement = findPart(".word-takes");
    const takeCount = takesHere === null ? takes : Math.min(takesHere.get(name) ?? 0, requiredTakes);
    if (countElement) countElement.textContent = texts.takes(takeCount, requiredTakes);
    row?.classList.toggle("enough", takeCount >= requiredTakes);
    findPart(".word-say")?.classList.toggle("talking", recording === name && isReadyForSpeech);
    const judgment = judgments.get(name);
    const judgmentElement = findPart(".word-judged");
    const recordingText = isReadyForSpeech ? texts.saying : strings.voice.opening;
    const text = recording === name ? recordingText : judgment ? describeJudgment(judgment) : "";
    if (judgmentElement && judgmentElement.textContent !== text) judgmentElement.textContent = text;
    judgmentElement?.classList.toggle("wrong", recording !== name && judgment !== undefined && judgment.code !== null);
  }
}

/** Returns the verdict on a take in words. */
function describeJudgment({ code, text, peak, seconds }: TakeJudged): string {
  const texts = strings.voice.words;
  const codeTexts: Readonly<Record<string, string>> = texts.codes;
  const level = peak > 0 ? Math.round(20 * Math.log10(peak)) : -96;
  if (code !== null) return `${codeTexts[code] ?? text} ${texts.measured(level, seconds.toFixed(1))}`;
  return `${peak < QUIET_PEAK ? texts.quiet : texts.good} ${texts.measured(level, seconds.toFixed(1))}`;
}
