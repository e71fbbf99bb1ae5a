// All that the page knows of a kind of derivation.
import type { ComponentChildren, JSX } from "preact";
import type { Fit } from "../../api/fits";
import type { DerivationRequest, DerivationResult } from "../../api/types";

/** A picture that shows what came out. */
export interface Shows {
  readonly file: string;
  readonly alt: () => string;
  /** As it is chosen among others of one kind; the kind's own name where there is none. */
  readonly label?: () => string;
  /** The same standing still, where the file moves. */
  readonly still?: string;
  readonly caption?: () => string;
}

/** A file sent beside a request, by the name of its form part. */
export interface Part {
  readonly name: "bvh" | "texture" | "chart";
  readonly file: File;
}

/** A body among the files that can be turned here. */
export interface Turns {
  readonly file: string;
  readonly label: () => string;
  /** Whether the pictures are rather something to look up. */
  readonly first?: boolean;
}

/** What is asked of a person who chooses this kind. */
export interface OptionProps<Wishes> {
  readonly parent: Fit;
  /** Whether the fit found the light, so that it can be taken out of the picture. */
  readonly hasLight: boolean;
  readonly wishes: Wishes;
  readonly onWish: (changed: Partial<Wishes>) => void;
}

export interface Smaller {
  readonly request: DerivationRequest;
  readonly refusal: string;
  readonly make: string;
}

/** Wishes are what can be chosen. Words are asked for when they are shown, in the language of that moment. Kinds that share one by its name share the choice as well. */
export interface Kind<Wishes = unknown> {
  readonly request: (wishes: Wishes) => DerivationRequest;
  /** A file that comes along with the request, if one was chosen. */
  readonly part?: (wishes: Wishes) => Part | null;
  /** What has yet to be chosen before it can be made; null if nothing has. */
  readonly lacks?: (wishes: Wishes) => string | null;
  /** Without it the kind is made without further questions. */
  readonly Options?: (props: OptionProps<Wishes>) => JSX.Element;
  readonly pictures: readonly Shows[];
  /** Of files that come by number, how they are shown; null of those that are no pictures. */
  readonly pictureOf?: (file: string) => Shows | null;
  readonly turns?: Turns;
  /** Whether its measurements can be had as a table. */
  readonly hasTable?: boolean;
  /** Instead of what was refused because it asked for more than can be had: the most, and how that is said. */
  readonly smaller?: (largest: number) => Smaller;
  /** What there is to say of a result of this kind; null of any other. */
  readonly told?: (result: DerivationResult) => ComponentChildren;
}
