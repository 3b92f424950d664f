import { createButton, h } from "../../dom";
import { iconNameOf, createIcon } from "../../icons";
import type { DisplayClass, TopicChoice } from "../../protocol";
import type { DisplayState } from "../../state/displays";
import { findObviousDisplay } from "../../state/obvious-display";
import { shortNameOf } from "../../state/views/catalog";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { Dialog } from "../../widgets/dialog";

/** The number of rows by which Page Up and Page Down move. */
const PAGE_ROWS = 8;

interface Choice {
  cls: string;
  topic: string | null;
  element: HTMLElement;
}

type Tab = "type" | "topic";

/** RViz's dialog that adds a display, by its type or by a topic that it shows. */
export class AddDialog {
  private readonly dialog: Dialog;
  private readonly search = h("input", { class: "field" });
  private readonly list = h("div", { class: "choices", role: "listbox", aria: { label: strings.displays.addTitle } });
  private readonly nameField = h("input", { class: "field wide" });
  private readonly showAllBox = h("input", { class: "check" });
  private readonly showAllLabel: HTMLElement;
  private readonly tabs: Readonly<Record<Tab, HTMLButtonElement>>;
  private readonly stopListening: () => void;
  private tab: Tab = "type";
  private isWaiting = false;
  private choices: Choice[] = [];
  private chosenChoice: Choice | null = null;
  private suggestedName = "";

  /** @param group - the group that the display is added to; null for none. */
  constructor(
    private readonly session: Session,
    private readonly group: DisplayState | null,
  ) {
    const texts = strings.displays;
    this.tabs = { type: this.createTab("type", texts.byType), topic: this.createTab("topic", texts.byTopic) };
    this.search.type = "search";
    this.search.placeholder = texts.search;
    this.search.setAttribute("aria-label", texts.search);
    this.search.addEventListener("input", () => this.fill());
    this.search.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.list.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.nameField.setAttribute("aria-label", texts.displayName);
    this.nameField.maxLength = 200;
    this.showAllBox.type = "checkbox";
    this.showAllBox.addEventListener("change", () => this.fill());
    this.showAllLabel = h("label", { class: "check-label" }, this.showAllBox, texts.showAll);
    this.dialog = new Dialog(
      texts.addTitle,
      [
        h("div", { class: "tabs", role: "tablist" }, this.tabs.type, this.tabs.topic),
        h("div", { class: "search-box" }, createIcon("search"), this.search),
        this.list,
        this.showAllLabel,
        h("label", { class: "form-field" }, h("span", {}, texts.displayName), this.nameField),
        ...(group ? [h("p", { class: "hint" }, texts.into(group.name))] : []),
      ],
      [{ label: strings.shell.cancel }, { label: texts.add, isPrimary: true, run: () => this.addDisplay() }],
      "add-dialog",
    );
    this.stopListening = session.configuration.choicesArrived.on(() => {
      if (!this.isWaiting) return; // the list must not change under the pointer
      this.isWaiting = false;
      this.fill();
    });
    this.dialog.element.addEventListener("close", () => this.stopListening());
  }

  open(): void {
    this.dialog.open(this.search);
    this.showTab("type");
  }

  private createTab(tab: Tab, label: string): HTMLButtonElement {
    const tabButton = createButton(label, () => this.showTab(tab), "tab", label);
    tabButton.setAttribute("role", "tab");
    tabButton.addEventListener("keydown", (event) => {
      if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
      const otherTab = tab === "type" ? "topic" : "type";
      this.showTab(otherTab);
      this.tabs[otherTab].focus();
    });
    return tabButton;
  }

  private showTab(tab: Tab): void {
    this.tab = tab;
    for (const name of ["type", "topic"] as const) {
      this.tabs[name].setAttribute("aria-selected", String(name === tab));
      this.tabs[name].tabIndex = name === tab ? 0 : -1;
    }
    this.showAllLabel.hidden = tab !== "topic";
    const { configuration } = this.session;
    this.isWaiting = tab === "topic" || configuration.choices === null;
    if (this.isWaiting) configuration.requestChoices();
    this.fill();
  }

  private fill(): void {
    const query = this.search.value.trim().toLowerCase();
    const previousChoice = this.chosenChoice;
    this.choices = [];
    const entries = this.tab === "type" ? this.listTypes(query) : this.listTopics(query);
    this.list.replaceChildren(...entries);
    this.list.role = entries.length > 0 ? "listbox" : "group"; // a listbox without options is none
    if (entries.length === 0) this.list.append(h("p", { class: "empty" }, this.explainEmptyList()));
    const sameChoice = this.choices.find((choice) => choice.cls === previousChoice?.cls && choice.topic === previousChoice.topic);
    this.choose(sameChoice ?? (query === "" ? null : (this.choices[0] ?? null)));
    const firstChoice = this.choices[0];
    if (firstChoice && !sameChoice) firstChoice.element.tabIndex = 0;
  }

  private explainEmptyList(): string {
    const texts = strings.displays;
    if (this.isWaiting) return texts.requestingTopics;
    return this.tab === "topic" && this.offeredChoices.topics.length === 0 ? texts.noTopics : texts.notFound;
  }

  private get offeredChoices(): { classes: DisplayClass[]; topics: TopicChoice[] } {
    const { choices } = this.session.configuration;
    return this.isWaiting || choices === null ? { classes: [], topics: [] } : choices;
  }

  private listTypes(query: string): HTMLElement[] {
    return this.offeredChoices.classes
      .map(({ cls, messages }) => ({ cls, summary: describeDisplay(cls), messages }))
      .filter(({ cls, summary, messages }) => [cls, summary, ...messages].some((text) => text.toLowerCase().includes(query)))
      .map(({ cls, summary }) => this.createChoice(cls, null, shortNameOf(cls), summary));
  }

  private listTopics(query: string): HTMLElement[] {
    const matchesQuery = ({ topic, message, classes }: TopicChoice): boolean =>
      [topic, message, ...classes].some((text) => text.toLowerCase().includes(query));
    const listedTopics = this.offeredChoices.topics.filter((topicChoice) => topicChoice.classes.length > 0 || this.showAllBox.checked);
    return listedTopics.filter(matchesQuery).map((topicChoice) => {
      const { topic, message, classes } = topicChoice;
      const obviousClass = findObviousDisplay(topicChoice);
      const sortedClasses = [...classes].sort((a, b) => Number(b === obviousClass) - Number(a === obviousClass));
      const rows = sortedClasses.map((cls) => this.createChoice(cls, topic, shortNameOf(cls), describeDisplay(cls)));
      const [obviousRow] = rows;
      const topicName = h("div", { class: "topic-name" }, topic, h("span", { class: "topic-type" }, message));
      // A click on the name chooses the display that most users want.
      for (const kind of ["click", "dblclick"] as const) {
        topicName.addEventListener(kind, () => obviousRow?.dispatchEvent(new MouseEvent(kind)));
      }
      const hint = classes.length === 0 ? h("p", { class: "hint" }, strings.displays.topicNotShown) : null;
      return h("div", { class: "topic-choice", role: "group", aria: { label: topic } }, topicName, ...rows, hint);
    });
  }

  private createChoice(cls: string, topic: string | null, name: string, summary: string): HTMLElement {
    const element = h(
      "div",
      { class: "choice-row", role: "option", tabIndex: -1, aria: { selected: "false" } },
      createIcon(iconNameOf(cls)),
      h("strong", {}, name),
      h("span", { class: "about" }, summary),
    );
    const choice: Choice = { cls, topic, element };
    element.addEventListener("click", () => this.choose(choice));
    element.addEventListener("focus", () => this.choose(choice));
    element.addEventListener("dblclick", () => {
      if (this.addDisplay()) this.dialog.close();
    });
    this.choices.push(choice);
    return element;
  }

  private choose(choice: Choice | null): void {
    this.chosenChoice = choice;
    for (const candidate of this.choices) {
      candidate.element.setAttribute("aria-selected", String(candidate === choice));
      candidate.element.tabIndex = candidate === choice ? 0 : -1;
    }
    this.dialog.isReady = choice !== null;
    // Keep a name that the user typed.
    if (choice && (this.nameField.value === "" || this.nameField.value === this.suggestedName)) {
      this.suggestedName = shortNameOf(choice.cls);
      this.nameField.value = this.suggestedName;
    }
    choice?.element.scrollIntoView({ block: "nearest" });
  }

  private onKeyDown(event: KeyboardEvent): void {
    const index = this.chosenChoice ? this.choices.indexOf(this.chosenChoice) : -1;
    const isInList = event.target !== this.search;
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: PAGE_ROWS, PageUp: -PAGE_ROWS }[event.key];
    if (step !== undefined) {
      const nextChoice = this.choices[Math.max(0, Math.min(this.choices.length - 1, index + step))];
      this.choose(nextChoice ?? null);
      if (isInList) nextChoice?.element.focus();
    } else if (isInList && event.key === "Enter") {
      if (this.addDisplay()) this.dialog.close();
    } else return;
    event.preventDefault();
  }

  private addDisplay(): boolean {
    if (!this.chosenChoice) return false;
    const { cls, topic } = this.chosenChoice;
    this.session.configuration.add(cls, this.nameField.value.trim() || shortNameOf(cls), this.group?.id ?? null, topic);
    return true;
  }
}

/** Returns the purpose of a display class, in one sentence. */
function describeDisplay(cls: string): string {
  return (strings.displays.about as Readonly<Record<string, string | undefined>>)[shortNameOf(cls)] ?? cls;
}
