import type { IconName } from "../icons";
import type { PropertyKind, PropertyValue } from "../protocol";
import type { ShownLevel } from "../state/displays";

/** One row of a property tree, as the tree draws it. */
export interface TreeItem {
  /** Unique in its tree and the same from one refresh to the next. */
  readonly key: string;
  readonly name: string;
  readonly kind: PropertyKind;
  readonly value: PropertyValue;
  readonly description: string;
  readonly icon?: IconName;
  /** Colours the row; a sign is shown too unless it is a display's own row. */
  readonly level?: ShownLevel;
  readonly showLevelIcon?: boolean;
  readonly strong?: boolean;
  readonly muted?: boolean;
  /** The tooltip of the name; by default, the name. */
  readonly hint?: string;
  /** Its name fills the row. */
  readonly wide?: boolean;
  /** Several of such rows can be selected at once. */
  readonly severally?: boolean;
  /** Shown behind the name, small. */
  readonly badge?: string;
  readonly options?: readonly string[];
  readonly minimum?: number | null;
  readonly maximum?: number | null;
  readonly readOnly?: boolean;
  /** Whether the row is open before the user decides. */
  readonly expanded?: boolean;
  /** The row is open against the user's choice: a search found a row below it. */
  readonly open?: boolean;
  readonly children?: () => readonly TreeItem[];
  /** A double click on the name, or Enter on the row. */
  readonly activate?: () => void;
  /** Whether its value is read each time it is shown: it changes with the drawing of the page. */
  readonly live?: boolean;
  /** Asks for the names to choose from, of a `topic`. */
  readonly ask?: (show: (names: readonly string[]) => void) => void;
  /** Takes an edit; a row without it is read-only. */
  readonly set?: (value: PropertyValue) => void;
}

/** The right half of a row. */
export interface Editor {
  readonly element: HTMLElement;
  /** Shows the item's value, unless the user is just editing it. */
  show(item: TreeItem): void;
  /** Takes the keyboard; false when there is nothing to edit. */
  focus(): boolean;
  /** Space on the row: flips a box. */
  toggle?(): void;
}
