type Child = Node | string | null;

interface Props {
  class?: string;
  title?: string;
  role?: string;
  tabIndex?: number;
  data?: Readonly<Record<string, string>>;
  aria?: Readonly<Record<string, string>>;
  onClick?: (event: MouseEvent) => void;
}

/** Creates an element: `h("div", { class: "row" }, "text", child)`. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  props: Props = {},
  ...children: readonly Child[]
): HTMLElementTagNameMap[K] {
  const element: HTMLElement = document.createElement(tag);
  if (props.class !== undefined) element.className = props.class;
  if (props.title !== undefined) element.title = props.title;
  if (props.role !== undefined) element.setAttribute("role", props.role);
  if (props.tabIndex !== undefined) element.tabIndex = props.tabIndex;
  for (const [name, value] of Object.entries(props.data ?? {})) element.dataset[name] = value;
  for (const [name, value] of Object.entries(props.aria ?? {})) element.setAttribute(`aria-${name}`, value);
  if (props.onClick) element.addEventListener("click", props.onClick);
  element.append(...children.filter((child) => child !== null));
  return element as HTMLElementTagNameMap[K];
}

/** Creates a push button; `label` is its tooltip, and its accessible name if it has no text. */
export function createButton(label: string, onClick: () => void, className: string, ...children: readonly Child[]): HTMLButtonElement {
  const hasText = children.some((child) => typeof child === "string");
  const aria = hasText ? {} : { label };
  const element = h("button", { class: className, title: label, aria, onClick }, ...children);
  element.type = "button";
  return element;
}

/** Returns whether another page shows this one in a frame, as a page with terminals does. */
export function isFramed(): boolean {
  return window.parent !== window;
}

/** Returns a function that calls `run` once before the next paint, however often it is called itself. */
export function coalesce(run: () => void): () => void {
  let isScheduled = false;
  return () => {
    if (isScheduled) return;
    isScheduled = true;
    requestAnimationFrame(() => {
      isScheduled = false;
      run();
    });
  };
}
