#include "names.h"

#include <stdint.h>
#include <string.h>

#include "host/base/hashing.h"

struct names {
    struct arena *arena;
    named **slots;
    size_t slot_count; /* a power of two */
    named **entries;   /* in the order of declaration */
    int count;
};

names *names_new(struct arena *arena) {
    names *made = arena_alloc(arena, sizeof *made);
    made->arena = arena;
    made->slot_count = 64;
    made->slots = arena_alloc(arena, made->slot_count * sizeof *made->slots);
    return made;
}

static size_t slot_of(const names *all, const char *text, size_t length) {
    const uint32_t hash = hash_text(text, length);
    return (hash ^ (hash >> 15)) & (all->slot_count - 1);
}

named *names_find(const names *all, const char *text, size_t length) {
    named *each = all->slots[slot_of(all, text, length)];
    while (each != NULL &&
           (strncmp(each->symbol.name, text, length) != 0 || each->symbol.name[length] != '\0')) {
        each = each->next;
    }
    return each;
}

static void link_in(names *all, named *entry) {
    const size_t slot = slot_of(all, entry->symbol.name, strlen(entry->symbol.name));
    entry->next = all->slots[slot];
    all->slots[slot] = entry;
}

named *names_add(names *all, const char *text, size_t length) {
    if ((size_t)all->count >= all->slot_count) {
        all->slot_count *= 4;
        all->slots = arena_alloc(all->arena, all->slot_count * sizeof *all->slots);
        for (int i = 0; i < all->count; i++) {
            link_in(all, all->entries[i]);
        }
    }
    named *entry = arena_alloc(all->arena, sizeof *entry);
    entry->symbol.name = arena_copy(all->arena, text, length);
    entry->symbol.text = "";
    entry->symbol.unit = "";
    entry->symbol.effect = -1;
    all->entries = arena_room(all->arena, all->entries, all->count, sizeof *all->entries);
    all->entries[all->count++] = entry;
    link_in(all, entry);
    return entry;
}

void names_offer(const names *all, int effect_index, nearest *search) {
    for (int i = 0; i < all->count; i++) {
        const named *each = all->entries[i];
        const bool visible =
            effect_index == -2 || each->symbol.effect == -1 || each->symbol.effect == effect_index;
        if (visible && !each->is_placeholder) {
            nearest_offer(search, each->symbol.name);
        }
    }
}
