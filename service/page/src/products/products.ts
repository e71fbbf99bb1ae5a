// What is made of a fit: asked for, and followed to its end.
import { useEffect, useState } from "preact/hooks";
import { getProduct, makeProduct } from "../api/calls";
import { problemFrom, untilReached } from "../api/client";
import { pause } from "../api/connection";
import type { Problem, Product, ProductRequest } from "../api/types";
import { isActive } from "../fit/watch";
import type { Part } from "./kinds/kind";

const LOOK_EVERY_MS = 1000;

/** A product at its end; `tell` hears of it on its way. The same options are the same product, made once. */
export async function made(fitId: string, asked: ProductRequest, part: Part | null, leaving: AbortSignal, tell?: (product: Product) => void): Promise<Product> {
  let product = await makeProduct(fitId, asked, part, leaving);
  while (isActive(product)) {
    tell?.(product);
    await pause(LOOK_EVERY_MS, leaving);
    const before = product;
    product = await untilReached(() => getProduct(before, leaving), leaving);
  }
  tell?.(product);
  return product;
}

export interface Products {
  /** Those asked for here, newest first. */
  readonly list: readonly Product[];
  readonly isAsking: boolean;
  readonly problem: Problem | null;
  readonly make: (asked: ProductRequest, part: Part | null) => Promise<void>;
}

/** `onMade` hears of what has succeeded. */
export function useProducts(fitId: string, onMade: (product: Product) => void): Products {
  const [list, setList] = useState<readonly Product[]>([]);
  const [isAsking, setAsking] = useState(false);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [leaving] = useState(() => new AbortController());
  useEffect(() => () => leaving.abort(), []);
  const put = (seen: Product) => setList((old) => [seen, ...old.filter(({ id }) => id !== seen.id)]);
  const make = async (asked: ProductRequest, part: Part | null) => {
    setAsking(true);
    setProblem(null);
    try {
      const ended = await made(fitId, asked, part, leaving.signal, put);
      if (ended.state === "succeeded") onMade(ended);
    } catch (error) {
      if (!leaving.signal.aborted) setProblem(problemFrom(error));
    } finally {
      setAsking(false);
    }
  };
  return { list, isAsking, problem, make };
}
