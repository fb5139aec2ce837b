// Numbers of workgroups and invocations of a dispatch along a line. Commands::dispatch folds a long line into rows, so
// gl_WorkGroupID.x alone is no number. Numbers beyond the line exist in the last row; the shader ignores them.
uint group_number() { return gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x; }

// For workgroups along x only.
uint invocation_number() { return group_number() * gl_WorkGroupSize.x + gl_LocalInvocationIndex; }
