// Only here to give the precompiled header a target to belong to.
