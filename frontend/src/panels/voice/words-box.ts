import { button, h } from "../../dom";
import { icon } from "../../icons";
import type { EnrolledWord, TakeJudged } from "../../protocol";
import type { VoiceState } from "../../state/voice/voice";
import type { WordsState } from "../../state/voice/words";
import { strings } from "../../strings";
import { textField } from "../../widgets/controls";
import { askName } from "../../widgets/dialog";
import { saveText } from "../../widgets/save-file";
import { obstacle } from "./voice-words";

/** A recording whose peak is below this counts as quiet: -24 dB. */
const QUIET = 0.06;

/** The words that the user enrolls: each is spoken three times, with a button held down. */
export class WordsBox {
  readonly element: HTMLDetailsElement;
  private readonly list = h("div", { class: "word-list", role: "list" });
  private readonly problem = h("p", { class: "note wrong", role: "status" });
  private readonly file = h("p", { class: "note" });
  private readonly field: HTMLInputElement;
  private readonly here: HTMLElement;
  private readonly hereNote = h("span", { class: "note" });
  private readonly hereDone = h("strong", { role: "status" });
  private shownNames = "";
  /** Whether the next word to speak takes the focus once the words are known. */
  private focusDue = false;

  constructor(
    private readonly words: WordsState,
    private readonly voice: VoiceState,
  ) {
    const texts = strings.voice.words;
    const add = (): void => {
      words.addWord(field.value);
      field.value = "";
    };
    const field = (this.field = textField(texts.choose, () => undefined));
    field.maxLength = 100;
    const suggestions = h("datalist", {}, ...texts.suggestions.map((suggestion) => new Option(suggestion)));
    suggestions.id = "voice-word-suggestions";
    field.setAttribute("list", suggestions.id);
    field.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && !event.isComposing) add();
    });
    const picker = h("input", { aria: { label: texts.importFile } });
    picker.type = "file";
    picker.accept = ".json,application/json";
    picker.hidden = true;
    picker.addEventListener("change", () => {
      const [chosen] = picker.files ?? [];
      picker.value = "";
      void chosen?.text().then((text) => words.importFile(text));
    });
    const done = button(texts.endHereHint, () => words.enrollHere(false), "tool framed", texts.endHere);
    this.here = h("div", { class: "word-here" }, this.hereDone, this.hereNote, done);
    this.element = h(
      "details",
      { class: "word-box" },
      h("summary", {}, texts.title),
      this.here,
      h("p", { class: "note" }, texts.hint),
      h("div", { class: "voice-row" }, field, suggestions, button(texts.addHint, add, "tool framed", texts.add)),
      this.list,
      this.problem,
      h(
        "div",
        { class: "voice-row" },
        button(texts.importHint, () => picker.click(), "tool framed", icon("upload"), texts.importFile),
        button(texts.exportHint, () => words.requestFile(), "tool framed", icon("download"), texts.exportFile),
        picker,
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
  watch(seen: boolean): void {
    this.words.watch(seen && this.element.open);
  }

  /** Starts to enroll the words again at the user's location. The panel must be in front. */
  enrollHere(): void {
    this.element.open = true;
    this.focusDue = true;
    this.words.enrollHere(true);
    this.here.scrollIntoView({ block: "nearest" });
  }

  private show(): void {
    const { words: texts } = this;
    const all = texts.enrolledWords;
    const key = JSON.stringify(all.map(({ name }) => name));
    // Replace the rows only if words changed: a button that is held must stay in place.
    if (key !== this.shownNames) {
      this.shownNames = key;
      this.list.replaceChildren(...all.map((word) => this.row(word)));
    }
    all.forEach((word, index) => this.update(this.list.children[index], word));
    this.showProblem();
    this.showHere();
    this.file.textContent = texts.file === "" ? "" : strings.voice.words.keptIn(texts.file);
  }

  private showProblem(): void {
    const problem = this.words.problem ?? (this.voice.microphone.problem === null ? null : obstacle(this.voice));
    if (this.problem.textContent !== problem) this.problem.textContent = problem;
    this.problem.hidden = problem === null;
  }

  private showHere(): void {
    const { enrolledWords: words, takesHere, missingHere, requiredTakes, file } = this.words;
    const texts = strings.voice.words;
    this.here.hidden = takesHere === null;
    if (takesHere === null) return;
    const [next] = missingHere;
    const doneCount = words.length - missingHere.length;
    const progress = words.length === 0 ? texts.hereNone : next ? texts.hereDone(doneCount, words.length) : texts.hereAll;
    if (this.hereDone.textContent !== progress) this.hereDone.textContent = progress;
    this.hereNote.textContent = texts.here(requiredTakes);
    if (!this.focusDue || file === "") return;
    this.focusDue = false;
    const row = next && this.list.children[words.indexOf(next)];
    (row?.querySelector<HTMLElement>(".word-say") ?? this.field).focus();
  }

  private row({ name }: EnrolledWord): HTMLElement {
    const texts = strings.voice.words;
    const { words } = this;
    const say = button(texts.say(name), () => undefined, "tool framed word-say", icon("microphone"));
    const begin = (): void => void words.startTake(name);
    const end = (): void => {
      if (words.recording === name) words.endTake();
    };
    say.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      say.setPointerCapture(event.pointerId);
      begin();
    });
    for (const each of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) say.addEventListener(each, end);
    say.addEventListener("keydown", (event) => {
      if (event.key !== " " && event.key !== "Enter") return;
      event.preventDefault();
      if (!event.repeat) begin();
    });
    say.addEventListener("keyup", (event) => {
      if (event.key === " " || event.key === "Enter") end();
    });
    const rename = button(texts.rename(name), () => askName(texts.renameTitle, texts.name, name, (to) => words.rename(name, to)), "tool bare", icon("rename"));
    const remove = button(texts.remove(name), () => words.remove(name), "tool bare", icon("remove"));
    const head = h("div", { class: "word-head" }, say, h("span", { class: "word-name" }, name), h("span", { class: "word-takes note" }), rename, remove);
    return h("div", { class: "word", role: "listitem" }, head, h("div", { class: "note word-judged", role: "status" }));
  }

  private update(row: Element | undefined, { name, takes }: EnrolledWord): void {
    const { recording, isHearing, requiredTakes, judgments, takesHere } = this.words;
    const texts = strings.voice.words;
    const find = (part: string): Element | null => row?.querySelector(part) ?? null;
    const count = find(".word-takes");
    const counted = takesHere === null ? takes : Math.min(takesHere.get(name) ?? 0, requiredTakes);
    if (count) count.textContent = texts.takes(counted, requiredTakes);
    row?.classList.toggle("enough", counted >= requiredTakes);
    find(".word-say")?.classList.toggle("talking", recording === name && isHearing);
    const last = judgments.get(name);
    const line = find(".word-judged");
    const saying = isHearing ? texts.saying : strings.voice.opening;
    const text = recording === name ? saying : last ? judgment(last) : "";
    if (line && line.textContent !== text) line.textContent = text;
    line?.classList.toggle("wrong", recording !== name && last !== undefined && last.code !== null);
  }
}

/** Returns the verdict on a take in words. */
function judgment({ code, text, peak, seconds }: TakeJudged): string {
  const texts = strings.voice.words;
  const known: Readonly<Record<string, string>> = texts.codes;
  const level = peak > 0 ? Math.round(20 * Math.log10(peak)) : -96;
  if (code !== null) return `${known[code] ?? text} ${texts.measured(level, seconds.toFixed(1))}`;
  return `${peak < QUIET ? texts.quiet : texts.good} ${texts.measured(level, seconds.toFixed(1))}`;
}
