// Shares as a person reads them.
import { percent as written } from "../messages/figures";
import { messages } from "../messages";

export function percent(share: number): string {
  return share > 0 && share < 0.005 ? messages.products.lessThan(written(0.01)) : written(share);
}
