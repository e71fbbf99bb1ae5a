import{d as v,e as p,g as M,i as x,u as w,v as y,x as P,z as g}from"/page/chunk.AL4O2LQE.js";var l=3.2,e=96,k=.08,c=2,A=`
  out vec2 vPlace;
  void main() {
    vPlace = uv;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`,F=`
  precision highp float;
  in vec2 vPlace;
  uniform sampler2D near;
  uniform float side;
  uniform vec2 walked;
  out vec4 colour;
  void main() {
    vec2 metres = (vPlace - 0.5) * side;
    float fade = 1.0 - smoothstep(0.25, 1.0, length(metres) / (0.5 * side));
    vec2 cell = abs(fract((metres + walked) / 0.5 + 0.5) - 0.5) * 0.5;
    vec2 width = max(fwidth(metres), vec2(0.004));
    vec2 line = 1.0 - smoothstep(vec2(0.0), width, cell);
    float dark = texture(near, vec2(vPlace.x, 1.0 - vPlace.y)).r;
    float alpha = max(max(line.x, line.y) * 0.3 * fade, 0.1 * fade);
    colour = vec4(mix(vec3(0.5), vec3(0.0), dark), max(alpha, 0.5 * dark));
  }
`,E=class{mesh;near;constructor(){this.near=new y(new Uint8Array(e*e),e,e,p),this.near.minFilter=this.near.magFilter=v;let r=new g({glslVersion:M,vertexShader:A,fragmentShader:F,transparent:!0,depthWrite:!1,uniforms:{near:{value:this.near},side:{value:l},walked:{value:new x}}});this.mesh=new w(new P(l,l).rotateX(-Math.PI/2),r)}layUnder(r,t,s=r.reduce((a,{y:i})=>Math.min(a,i),1/0)){this.mesh.position.set(t.x,s,t.z);let a=new Float32Array(e*e);for(let{x:o,y:n,z:S}of r){let d=Math.floor(((o-t.x)/l+.5)*e),f=Math.floor(((S-t.z)/l+.5)*e);if(d<0||f<0||d>=e||f>=e)continue;let u=f*e+d;a[u]=Math.max(a[u],Math.exp((s-n)/k))}let i=this.near.image.data;L(L(a)).forEach((o,n)=>i[n]=Math.min(255,Math.round(255*o))),this.near.needsUpdate=!0}passUnder(r,t){this.mesh.material.uniforms.walked.value.set(r,-t)}dispose(){this.near.dispose(),this.mesh.geometry.dispose(),this.mesh.material.dispose()}};function L(m){return m.map((r,t)=>{let[s,a]=[Math.floor(t/e),t%e],[i,h]=[0,0];for(let o=Math.max(0,s-c);o<=Math.min(e-1,s+c);o++)for(let n=Math.max(0,a-c);n<=Math.min(e-1,a+c);n++)i+=m[o*e+n],h+=1;return i/h})}export{E as a};
