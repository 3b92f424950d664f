import { h } from "../../dom";

/** The suggestions of a text field, which refers to the list by its ID. */
export interface Suggestions {
  readonly element: HTMLDataListElement;
  show(items: readonly (readonly [string, string])[]): void;
}

/** Returns a list of suggestions, each with a text beside it. */
export function createSuggestions(id: string): Suggestions {
  const element = h("datalist");
  element.id = id;
  return {
    element,
    show: (items) => element.replaceChildren(...items.map(([value, text]) => new Option(text, value))),
  };
}
