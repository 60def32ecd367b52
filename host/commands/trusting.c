#include "trusting.h"

#include "host/run/twins.h"

load_keep trusting_keep(const image_settings *settings) {
    image_settings plain;
    return twins_plain(settings, &plain) ? KEEP_EQUATIONS : KEEP_IMAGE;
}

image *trusting_plain(const loaded *made) {
    const image *im = made->image;
    image_settings plain;
    if (im == NULL || made->equations == NULL || !twins_plain(&im->settings, &plain)) {
        return NULL;
    }
    diags *unsaid = diags_new(); /* already reported for the run's image */
    image *without = image_make(made->equations, made->equations->instance->conserve, &plain,
                                IMAGE_TO_RUN, unsaid);
    diags_free(unsaid);
    return without;
}
