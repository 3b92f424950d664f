import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import { strings } from "../../strings";

/** A line of a file in a list; `name` is the emphasized part of its text. */
export interface ListedPlace {
  readonly line: number;
  readonly textBefore: string;
  readonly name: string;
  readonly textAfter: string;
  readonly open: () => void;
}

/** The listed places of one file. */
export interface ListedFile {
  readonly name: string;
  readonly path: string;
  readonly places: readonly ListedPlace[];
}

/** A list of places below the text: arrows move, Enter opens a place, Escape closes the list. */
export class PlaceList {
  readonly element = h("section", { class: "place-list" });
  private readonly heading = h("h3");
  private readonly list = h("div", { class: "place-list-items", role: "listbox" });
  private places: readonly ListedPlace[] = [];

  /** @param onClosed - called when the user has closed the list, and the focus is to return to the text. */
  constructor(private readonly onClosed: () => void) {
    const closeButton = createButton(strings.close, () => this.close(), "tool bare", createIcon("close"));
    this.element.append(h("header", {}, this.heading, closeButton), this.list);
    this.element.hidden = true;
    this.list.addEventListener("click", ({ target }) => {
      const option = target instanceof Element ? target.closest<HTMLElement>("[role=option]") : null;
      if (option) this.openPlace(this.options.indexOf(option));
    });
    this.list.addEventListener("keydown", (event) => this.onKeyDown(event));
  }

  /** Shows places and focuses the first one. */
  show(heading: string, files: readonly ListedFile[]): void {
    this.heading.textContent = heading;
    this.list.setAttribute("aria-label", heading);
    this.places = files.flatMap(({ places }) => places);
    const groups = files.map(({ name, path, places }) =>
      h(
        "div",
        { role: "group", aria: { label: name } },
        h("div", { class: "place-list-file", title: path, aria: { hidden: "true" } }, name),
        ...places.map(createOption),
      ),
    );
    this.list.replaceChildren(...groups);
    this.element.hidden = false;
    this.focus(0);
  }

  close(): void {
    this.element.hidden = true;
    this.list.replaceChildren();
    this.places = [];
    this.onClosed();
  }

  private get options(): HTMLElement[] {
    return [...this.list.querySelectorAll<HTMLElement>("[role=option]")];
  }

  private openPlace(index: number): void {
    this.select(index);
    this.places[index]?.open();
  }

  private select(index: number): void {
    for (const [position, option] of this.options.entries()) {
      option.tabIndex = position === index ? 0 : -1;
      option.setAttribute("aria-selected", String(position === index));
    }
  }

  private focus(index: number): void {
    this.select(index);
    this.options[index]?.focus();
  }

  private onKeyDown(event: KeyboardEvent): void {
    const { options } = this;
    const index = options.findIndex((option) => option.tabIndex === 0);
    const lastIndex = options.length - 1;
    const nextIndex = { ArrowDown: Math.min(index + 1, lastIndex), ArrowUp: Math.max(index - 1, 0), Home: 0, End: lastIndex }[event.key];
    if (nextIndex !== undefined) this.focus(nextIndex);
    else if (event.key === "Enter" || event.key === " ") this.openPlace(index);
    else if (event.key === "Escape") this.close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

function createOption({ line, textBefore, name, textAfter }: ListedPlace): HTMLElement {
  return h(
    "div",
    { class: "place-list-place", role: "option", tabIndex: -1 },
    h("span", { class: "place-list-line" }, String(line)),
    h("code", {}, textBefore, h("strong", {}, name), textAfter),
  );
}
