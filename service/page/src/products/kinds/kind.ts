// All that the page knows of a kind of product.
import type { ComponentChildren, JSX } from "preact";
import type { ProductRequest, ProductResult } from "../../api/types";

/** A file sent beside a request, by the name of its form part. */
export interface Part {
  readonly name: "bvh";
  readonly file: File;
}

/** What is asked of a person who chooses this kind. */
export interface OptionProps<Wishes> {
  /** Whether the fit found the light, so that it can be taken out of the picture. */
  readonly hasLight: boolean;
  readonly wishes: Wishes;
  readonly onWish: (changed: Partial<Wishes>) => void;
}

/** Wishes are what can be chosen. */
export interface Kind<Wishes = unknown> {
  readonly request: (wishes: Wishes) => ProductRequest;
  /** A file that comes along with the request, if one was chosen. */
  readonly part?: (wishes: Wishes) => Part | null;
  /** What has yet to be chosen before it can be made; null if nothing has. */
  readonly lacks?: (wishes: Wishes) => string | null;
  /** Without it the kind is made without further questions. */
  readonly Options?: (props: OptionProps<Wishes>) => JSX.Element;
  /** The file that is shown as a picture. */
  readonly picture?: string;
  /** The body that can be turned on the stage, or what stands for it where there is none, and what it is called there. */
  readonly body?: { readonly file: string; readonly still?: string; readonly label: string };
  /** What there is to say of a result of this kind; nothing of any other. */
  readonly told?: (result: ProductResult) => ComponentChildren;
}
