// The calls this page makes, one function each.
import { jsonBody, request, requestJson } from "./client";
import type { BodyEstimate, BodyRequest, Fit, FitRequest, FitResult, InitialPose, InitialPoseRequest, PointsProposal, PointsRequest, Product, ProductRequest, UploadedImage } from "./types";

/** What the root of the service answers to programs (api_schemas/service.py); the API document describes `/v1` alone. */
interface ServiceIndex {
  readonly retention_hours: number | null;
}

export function getIndex(): Promise<ServiceIndex> {
  return requestJson("/", { headers: { Accept: "application/json" } });
}

export function uploadImage(file: Blob, signal = new AbortController().signal): Promise<UploadedImage> {
  const form = new FormData();
  form.append("image", file, "picture");
  return requestJson("/v1/images", { method: "POST", body: form, signal });
}

export function initialPose(asked: InitialPoseRequest, signal: AbortSignal): Promise<InitialPose> {
  return requestJson("/v1/initial-poses", { ...jsonBody(asked), signal });
}

export function proposePoints(asked: PointsRequest, signal: AbortSignal): Promise<PointsProposal> {
  return requestJson("/v1/points", { ...jsonBody(asked), signal });
}

export function estimateBody(asked: BodyRequest, signal: AbortSignal): Promise<BodyEstimate> {
  return requestJson("/v1/bodies", { ...jsonBody(asked), signal });
}

/** The same as a GLB. */
export async function estimateMesh(asked: BodyRequest, signal: AbortSignal): Promise<ArrayBuffer> {
  return (await request("/v1/bodies?format=glb", { ...jsonBody(asked), signal })).arrayBuffer();
}

/** Every view has the id of its picture. */
export function submitFit(asked: FitRequest): Promise<Fit> {
  return requestJson("/v1/fits", jsonBody(asked));
}

/** A picture with its `request`, in one call as programs make it. */
export function postFit(picture: Blob, asked: string, signal: AbortSignal): Promise<Fit> {
  const form = new FormData();
  form.append("image", picture);
  form.append("request", asked);
  return requestJson("/v1/fits", { method: "POST", body: form, headers: { Prefer: "wait=60" }, signal });
}

export function getFit(id: string): Promise<Fit> {
  return requestJson(`/v1/fits/${id}`);
}

export function cancelFit(id: string): Promise<Fit> {
  return requestJson(`/v1/fits/${id}/cancel`, { method: "POST" });
}

export async function eraseFit(id: string): Promise<void> {
  await request(`/v1/fits/${id}`, { method: "DELETE" });
}

export function getResult(id: string): Promise<FitResult> {
  return requestJson(`/v1/fits/${id}/result`);
}

export function getAsked(id: string): Promise<FitRequest> {
  return requestJson(`/v1/fits/${id}/request`);
}

/** So long the service may take to answer with what is there at once, or soon. */
const WAIT_S = 20;

/** Ask for something to be made of a fit; `part` is a file that comes along, under the name of its form part. */
export function makeProduct(fitId: string, asked: ProductRequest, part: { name: string; file: File } | null, signal: AbortSignal): Promise<Product> {
  const path = `/v1/fits/${fitId}/products`;
  const headers = { Prefer: `wait=${WAIT_S}` };
  if (!part) {
    const { headers: json, ...body } = jsonBody(asked);
    return requestJson(path, { ...body, headers: { ...json, ...headers }, signal });
  }
  const form = new FormData();
  form.append("request", new Blob([JSON.stringify(asked)], { type: "application/json" }), "request.json");
  form.append(part.name, part.file, part.file.name);
  return requestJson(path, { method: "POST", body: form, headers, signal });
}

export function getProduct({ links }: Product, signal: AbortSignal): Promise<Product> {
  return requestJson(links.self, { signal });
}

/** A fit's picture as every browser shows it: a HEIC comes as a JPEG. */
export async function getPicture(path: string): Promise<Blob> {
  return (await request(path, { headers: { Accept: "image/png, image/webp, image/jpeg" } })).blob();
}

/** A file by its link: by fetch, not by an element's address, since a key may be needed. `onBytes` hears of each piece. */
export async function getFile(path: string, onBytes?: (count: number) => void): Promise<Blob> {
  const response = await request(path);
  if (!onBytes || !response.body) return response.blob();
  const pieces: Uint8Array<ArrayBuffer>[] = [];
  const reader = response.body.getReader();
  for (let piece = await reader.read(); !piece.done; piece = await reader.read()) {
    pieces.push(piece.value);
    onBytes(piece.value.length);
  }
  return new Blob(pieces, { type: response.headers.get("Content-Type") ?? "" });
}
